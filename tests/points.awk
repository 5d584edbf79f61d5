# Reads `ctest --verbose` and keeps what a person wants to see: each test's start and end, one line for each case
# that says how many points it tried, the whole output of cases that fail, and ctest's summary.

# Tests run side by side: what is kept of one goes by its number.

# "[points] <kernel> <accuracy> <target>: <n> points, max <x> ulp (bound <b>), ...": cases print many of these.
function add_points(test, line,    words, over) {
  sub(/.*\[points\] /, "", line)
  if (split(line, words, " ") > 9 && words[5] == "points," && words[6] == "max" && words[9] == "(bound") {
    checks[test]++
    points[test] += words[4]
    over = words[7] / (words[10] + 0)
    if (over >= largest[test]) {
      largest[test] = over
      sub(/:$/, "", words[3])
      where[test] = words[2] " " words[3]
    }
  } else {
    others[test, ++count[test]] = line
  }
}

function forget(test) {
  output[test] = where[test] = ""
  checks[test] = points[test] = largest[test] = count[test] = 0
}

function show(line) {
  print line
  fflush()
}

/^[0-9]+: / {
  test = $0 + 0
  line = substr($0, index($0, ": ") + 2)
  if (line ~ /^(Test command|Working Directory|Environment variables|Test timeout computed)/) next
  if (line ~ /^\[ RUN/) forget(test)
  output[test] = output[test] "    " line "\n"
  if (line ~ /\[points\]/) add_points(test, line)
  if (line ~ /^\[       OK/) {
    name = line
    sub(/^\[       OK \] /, "", name)
    if (checks[test] > 0) {
      show(sprintf("    %s: %.0f points in %d checks, largest error %.3g of its bound (%s)", name, points[test],
                   checks[test], largest[test], where[test]))
    }
    for (i = 1; i <= count[test]; ++i) show("    " name ": " others[test, i])
    forget(test)
  }
  if (line ~ /^\[  FAILED  \].*ms\)/) {
    show(output[test])
    forget(test)
  }
  next
}

/ Test +#[0-9]+: / {
  test = $0
  sub(/.* Test +#/, "", test)
  test += 0
  if ($0 !~ /Passed/) printf "%s", output[test]
  forget(test)
}

/^test [0-9]+$/ || /^UpdateCTestConfiguration/ || /^Constructing a list of tests/ ||
/^Done constructing a list/ || /^Updating test list/ || /^Checking test dependency/ ||
/^Test command:/ || /^Working Directory:/ || /^Test timeout computed/ || /^Internal ctest/ || /^UpdateCTest/ { next }

# Blank lines but those of the summary.
/^$/ && !ended { next }
/tests passed,/ { ended = 1 }
{ show($0) }
