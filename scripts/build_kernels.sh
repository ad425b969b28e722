#!/bin/sh
# Builds the Python module of the Fortran kernels.
# Usage: build_kernels.sh PYTHON PLACE OBJECTS LIBRARIES COMPILER MODULES TARGET
# PLACE takes what is made on the way, MODULES has the modules of the program, TARGET is the package.
# f2py writes the C layer; compiler and linker are called here, with the flags of the program.
set -eu
python=$1
place=$2
objects=$3
libraries=$4
compiler=$5
modules=$6
target=$7
mkdir -p "$place"

"$python" -m numpy.f2py --lower --build-dir "$place" -m _kernels fsrc/bindings/*.f90 > "$place/f2py.log" 2>&1 ||
    { cat "$place/f2py.log" >&2; exit 1; }
# f2py takes a kind that it does not know for a C float and says so only in passing.
if grep -i getctype "$place/f2py.log" >&2; then exit 1; fi

eval "$("$python" - << 'EOF'
import numpy, numpy.f2py, os, sysconfig
print(f"python_include={sysconfig.get_path('include')!r}")
print(f"numpy_include={numpy.get_include()!r}")
print(f"f2py_source={os.path.join(os.path.dirname(numpy.f2py.__file__), 'src')!r}")
print(f"suffix={sysconfig.get_config_var('EXT_SUFFIX')!r}")
EOF
)"
for source in "$place/_kernelsmodule.c" "$f2py_source/fortranobject.c"; do
    gcc -O2 -fPIC -DNPY_NO_DEPRECATED_API=NPY_1_7_API_VERSION -I"$python_include" -I"$numpy_include" -I"$f2py_source" \
        -c "$source" -o "$place/$(basename "$source" .c).o"
done
wrappers=
for source in "$place"/_kernels-f2pywrappers*.f*; do
    [ -e "$source" ] && wrappers="$wrappers $source"
done
# shellcheck disable=SC2086
$compiler -shared -O2 -fPIC -fopenmp -I"$modules" -J"$place" fsrc/bindings/*.f90 $wrappers \
    "$place/_kernelsmodule.o" "$place/fortranobject.o" $objects $libraries -o "$place/_kernels$suffix"
# Not written in place: whoever imports it meanwhile has the one before.
mv "$place/_kernels$suffix" "$target/.kernels_new" && mv "$target/.kernels_new" "$target/_kernels$suffix"
