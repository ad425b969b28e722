#!/bin/sh
# Every check of style; all of them run, the first failure decides the exit code at the end.
# Usage: lint.sh TOOLS BUILD
set -u
tools=$1
build=$2
failed=0

check() {
    name=$1
    shift
    if output=$("$@" 2>&1); then
        echo "ok      $name"
    else
        echo "FAILED  $name"
        printf '%s\n' "$output" | tail -60
        failed=1
    fi
}

formatted() {
    place=$build/format
    rm -rf "$place" && mkdir -p "$place" && cp -r fsrc tests .fprettify.rc "$place/"
    (cd "$place" && "$tools/fprettify" --config-file .fprettify.rc --silent -r fsrc tests) || return 1
    diff -ru fsrc "$place/fsrc" && diff -ru -x __pycache__ tests "$place/tests"
}

tools=$(cd "$tools" && pwd)
check 'compiler warnings' make --no-print-directory BUILD="$build/lint" STRICT=1 "$build/lint/rattle" "$build/lint/unit_tests"
check 'rooms and names of fsrc' "$tools/python" scripts/check_house.py
check 'style of Fortran' "$tools/fortitude" check --config .fortitude.toml fsrc tests
check 'format of Fortran' formatted
check 'style of Python' "$tools/ruff" check scripts tests
check 'format of Python' "$tools/ruff" format --check scripts tests
check 'page of all keys' sh -c "'$build/lint/rattle' --keys | diff - input/README.md"
exit $failed
