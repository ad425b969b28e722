#!/bin/sh
# Looks whether compiler, libraries and Python are there; installs what is missing with apt where root
# or password-free sudo allow it, else says how and stops. Never asks anything.
set -u

packages='gfortran gcc libfftw3-dev liblapack-dev python3-venv python3-dev'

missing() {
    command -v gfortran > /dev/null || echo 'gfortran'
    command -v gcc > /dev/null || echo 'gcc'
    found=
    for place in /usr ${CONDA_PREFIX:-} ${FFTW_ROOT:-}; do
        [ -e "$place/include/fftw3.f03" ] && found=yes
    done
    [ -n "$found" ] || echo 'FFTW with its Fortran header fftw3.f03'
    if command -v gfortran > /dev/null; then
        library=$(gfortran -print-file-name=liblapack.so)
        [ "$library" != liblapack.so ] || [ -e "${CONDA_PREFIX:-/nowhere}/lib/liblapack.so" ] || echo 'LAPACK'
    else
        echo 'LAPACK (cannot be looked for without gfortran)'
    fi
    if command -v python3 > /dev/null; then
        python3 -S -c 'import os, sys, sysconfig, importlib.util as u
ok = sys.version_info >= (3, 11) and u.find_spec("ensurepip") and u.find_spec("venv")
sys.exit(not (ok and os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h"))))' ||
            echo 'Python 3.11 with venv and headers'
    else
        echo 'Python 3.11 with venv and headers'
    fi
}

lacking=$(missing)
[ -z "$lacking" ] && exit 0

if command -v apt-get > /dev/null; then
    if [ "$(id -u)" = 0 ]; then as_root=
    elif sudo -n true 2> /dev/null; then as_root='sudo -n'
    else as_root=none
    fi
    if [ "$as_root" != none ]; then
        echo "installing: $packages"
        export DEBIAN_FRONTEND=noninteractive
        { $as_root apt-get update -qq && $as_root apt-get install -y -qq --no-install-recommends $packages; } > /dev/null ||
            echo 'apt could not install them.' >&2
        lacking=$(missing)
        [ -z "$lacking" ] && exit 0
    fi
fi

{
    echo 'rattle cannot be built, this is missing:'
    echo "$lacking" | sed 's/^/   /'
    echo 'One of these installs it:'
    echo "   apt:      sudo apt-get update && sudo apt-get install -y $packages"
    echo '   dnf:      sudo dnf install -y gcc-gfortran gcc fftw-devel lapack-devel blas-devel python3 python3-devel'
    echo '   conda:    conda install -y -c conda-forge gfortran gcc fftw liblapack libblas python'
    echo '   modules:  module load gcc fftw lapack python     (names differ from site to site; set FFTW_ROOT)'
} >&2
exit 1
