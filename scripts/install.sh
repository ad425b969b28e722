#!/bin/sh
# Installs program, Python package with its kernels, entry scripts, man page and bash completion below a folder.
# Usage: install.sh PYTHON BUILD OBJECTS LIBRARIES COMPILER PREFIX SCRIPTS PACKAGES
# SCRIPTS and PACKAGES say, relative to PREFIX, where scripts and package go.
set -eu
python=$1 build=$2 objects=$3 libraries=$4 compiler=$5 prefix=$6 scripts=$7 packages=$8

install -D -m 755 "$build/rattle" "$prefix/$scripts/rattle"
package=$prefix/$packages/rattle
rm -rf "$package"
mkdir -p "$package"
tar -C scripts/rattle --dereference --exclude=__pycache__ --exclude='*.so' -cf - . | tar -C "$package" -xf -
cp input/README.md "$package/keys.md"
scripts/build_kernels.sh "$python" "$build/installed" "$objects" "$libraries" "$compiler" "$build" "$package"
for name in campaign classify compare export plot report; do
    sed "1s|.*|#!$python|" "scripts/$name.py" > "$build/installed/script"
    install -D -m 755 "$build/installed/script" "$prefix/$packages/$name.py"
    ln -sf "$(realpath -s --relative-to="$prefix/$scripts" "$prefix/$packages")/$name.py" "$prefix/$scripts/rattle-$name"
done
page=$prefix/share/man/man1/rattle.1
completion=$prefix/share/bash-completion/completions/rattle
mkdir -p "$(dirname "$page")" "$(dirname "$completion")"
"$python" scripts/manual.py man "$build/rattle" > "$page"
"$python" scripts/manual.py bash "$build/rattle" > "$completion"
