#!/bin/sh
# Brings Fortran and Python below a folder into the one format. Usage: format.sh TOOLS FOLDER
# Left as they are: generated tables, and a test whose quoted ampersands fprettify 0.3.7 cannot take apart.
set -eu
tools=$1
cd "$2"
find fsrc tests \( -name '*.f90' -o -name '*.inc' \) ! -path '*/coefficients/*' ! -name test_namelist_text.f90 -exec \
    "$tools/fprettify" --config-file .fprettify.rc --silent {} +
"$tools/ruff" format --quiet scripts tests
