#!/bin/bash
# Builds the program in a bare Debian 13 with gfortran and with LLVM's flang, runs the unit tests and the ready scenes
# there, and holds the results against those of the program of this machine. Needs root, and Debian's packages: it makes
# the Debian in a folder of its own. Usage: run_compilers.sh [BUILD [FOLDER]]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
repository=$(cd "$here/../.." && pwd)
build=${1:-build}
debian=${2:-$build/debian_13}
python=${PYTHON:-$repository/.venv/bin/python}
compilers=${COMPILERS:-gfortran flang-new-19}
packages='gfortran flang-19 libomp-19-dev libfftw3-dev liblapack-dev make gawk'

cd "$repository"
inside() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/ LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    chroot "$debian" sh -c "cd /rattle && $1"; }

if [ ! -e "$debian/rattle" ]; then
    command -v debootstrap > /dev/null || apt-get install -y -qq debootstrap > /dev/null
    debootstrap --variant=minbase trixie "$debian" > /dev/null
    mkdir -p "$debian/rattle"
fi
mkdir -p "$build/compilers"
inside "dpkg -s $packages > /dev/null 2>&1 || { apt-get update -qq && apt-get install -y -qq --no-install-recommends $packages; } > /dev/null"
rm -rf "$debian/rattle/fsrc" "$debian/rattle/tests" "$debian/rattle/input"
git ls-files | tar -c -T - | tar -x -C "$debian/rattle"

# Maps and thresholds of few points.
fewer() {
    case $1 in
        *map.nml) echo '--set campaign.count=7,6' ;;
        *threshold.nml) echo '--set campaign.count=3' ;;
    esac
}

failed=0
for input in input/*.nml; do
    # shellcheck disable=SC2046
    "$build/rattle" --quiet --overwrite --output "$build/compilers/here" $(fewer "$input") "$input"
done
for compiler in $compilers; do
    place=build/$compiler
    echo "$compiler: $(inside "$compiler --version | head -1")"
    inside "make -j2 SYSTEM_LOOKED_AT=yes BUILD=$place FC=$compiler $place/rattle $place/unit_tests" > "$build/compilers/$compiler.log" 2>&1 ||
        { tail -20 "$build/compilers/$compiler.log"; failed=1; continue; }
    # Each suite and each scene in a process of its own, so that one that ends badly does not hide the others.
    for suite in $(inside "$place/unit_tests --list"); do
        inside "$place/unit_tests $suite" > "$build/compilers/suite.txt" 2>&1 ||
            { failed=1; echo "FAILED  suite $suite"; tail -5 "$build/compilers/suite.txt"; }
    done
    for input in input/*.nml; do
        inside "$place/rattle --quiet --overwrite --output $place/results $(fewer "$input") $input" || { failed=1; echo "FAILED  $input"; }
    done
    "$python" "$here/compare_results.py" "$build/compilers/here" "$debian/rattle/$place/results" || failed=1
done
exit $failed
