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
    rm -rf "$place" && mkdir -p "$place" && cp -r fsrc tests scripts .fprettify.rc pyproject.toml "$place/"
    scripts/format.sh "$tools" "$place" || return 1
    for folder in fsrc tests scripts; do
        diff -ru -x __pycache__ -x '*.so' "$folder" "$place/$folder" || return 1
    done
}

tools=$(cd "$tools" && pwd)
check 'compiler warnings' make --no-print-directory BUILD="$build/lint" STRICT=1 "$build/lint/rattle" "$build/lint/unit_tests"
check 'layout: folders, names, imports' "$tools/python" scripts/check_layout.py
check 'release: version, changelog, citation' "$tools/python" scripts/check_release.py
check 'style of Fortran' "$tools/fortitude" check --config .fortitude.toml fsrc tests
check 'format of Fortran and Python' formatted
check 'style of Python' "$tools/ruff" check scripts tests
check 'types of Python' "$tools/mypy" --cache-dir "$build/lint/mypy"
check 'links of pages' "$tools/python" scripts/check_links.py
check 'pages of studies: parts, tables' "$tools/python" scripts/check_studies.py
check 'pages: sentences, paragraphs, idioms, terms' "$tools/python" scripts/check_pages.py
check 'messages: idioms' "$tools/python" scripts/list_messages.py --idioms
check 'page of all keys' sh -c "sed '1,/^<!-- tables/d; /^<!-- end of tables/,\$d' input/KEYS.md > '$build/lint/tables.md'
    '$build/lint/rattle' --keys | diff - '$build/lint/tables.md'"
check 'table of quantities' sh -c "'$build/lint/rattle' --quantities | diff - scripts/rattle/quantities.csv"
exit $failed
