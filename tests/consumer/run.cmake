# Installs Microlane and builds two programs against the installed tree: by find_package and by pkg-config, with batch
# calls and with lane functions. Run with -DBUILD=<build tree> -DSOURCE=<here> -DSCRATCH=<dir> -DCXX=<compiler>
# -DCXX_FLAGS=<flags> -DBUILD_TYPE=<type> -DLIBDIR=<lib> -DGENERATOR=<generator>.
function(run)
  string(REPLACE ";" " " command "${ARGV}")
  message("$ ${command}")
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --config ${BUILD_TYPE})
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*.h)
list(JOIN headers " " headers)
message("Installed headers: ${headers}")

message("By find_package:")
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/batch)
run(${SCRATCH}/build/lanes)

message("By pkg-config:")
set(ENV{PKG_CONFIG_PATH} ${prefix}/${LIBDIR}/pkgconfig)
execute_process(COMMAND pkg-config --cflags microlane OUTPUT_VARIABLE cflags COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND pkg-config --libs microlane OUTPUT_VARIABLE libs COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(cflags UNIX_COMMAND "${CXX_FLAGS} ${cflags}")
separate_arguments(libs UNIX_COMMAND "${libs}")
foreach(program batch lanes)
  run(${CXX} -std=c++17 -O2 -ffp-contract=off -I${SOURCE} ${cflags} ${SOURCE}/${program}.cc -o ${SCRATCH}/${program} ${libs}
      -Wl,-rpath,${prefix}/${LIBDIR})
  run(${SCRATCH}/${program})
endforeach()

execute_process(COMMAND ${CXX} -std=c++17 ${cflags} -M ${SOURCE}/batch.cc OUTPUT_VARIABLE included
                COMMAND_ERROR_IS_FATAL ANY)
if(included MATCHES "/hwy/")
  message(FATAL_ERROR "batch.cc includes Highway:\n${included}")
endif()
message("batch.cc includes no Highway header.")
