# Reads `ctest --verbose` and keeps what a person wants to see: each test's start and end, one line for each case
# that says how many points it tried, the whole output of cases that fail, and ctest's summary.

# "[points] <kernel> <accuracy> <target>: <n> points, max <x> ulp (bound <b>), ...": cases print many of these.
function add_points(line,    words, over) {
  sub(/.*\[points\] /, "", line)
  if (split(line, words, " ") > 9 && words[5] == "points," && words[6] == "max" && words[9] == "(bound") {
    checks++
    points += words[4]
    over = words[7] / (words[10] + 0)
    if (over >= largest) {
      largest = over
      sub(/:$/, "", words[3])
      where = words[2] " " words[3]
    }
  } else {
    others[++count] = line
  }
}

function forget() {
  output = ""
  checks = points = largest = count = 0
  where = ""
}

function show(line) {
  print line
  fflush()
}

/^[0-9]+: / {
  line = substr($0, index($0, ": ") + 2)
  if (line ~ /^(Test command|Working Directory|Environment variables|Test timeout computed)/) next
  if (line ~ /^\[ RUN/) forget()
  output = output "    " line "\n"
  if (line ~ /\[points\]/) add_points(line)
  if (line ~ /^\[       OK/) {
    name = line
    sub(/^\[       OK \] /, "", name)
    if (checks > 0) {
      show(sprintf("    %s: %.0f points in %d checks, largest error %.3g of its bound (%s)", name, points, checks,
                   largest, where))
    }
    for (i = 1; i <= count; ++i) show("    " name ": " others[i])
    forget()
  }
  if (line ~ /^\[  FAILED  \].*ms\)/) {
    show(output)
    forget()
  }
  next
}

/ Test +#[0-9]+: / {
  if ($0 !~ /Passed/) printf "%s", output
  forget()
}

/^test [0-9]+$/ || /^UpdateCTestConfiguration/ || /^Constructing a list of tests/ ||
/^Done constructing a list/ || /^Updating test list/ || /^Checking test dependency/ ||
/^Test command:/ || /^Working Directory:/ || /^Test timeout computed/ || /^Internal ctest/ || /^UpdateCTest/ { next }

# Blank lines but those of the summary.
/^$/ && !ended { next }
/tests passed,/ { ended = 1 }
{ show($0) }
