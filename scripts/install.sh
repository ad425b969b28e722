#!/bin/sh
# Installs program, Python package with its kernels, entry scripts, man page and bash completion below a folder.
# Usage: install.sh PYTHON BUILD OBJECTS LIBRARIES COMPILER PREFIX SCRIPTS PACKAGES
# SCRIPTS and PACKAGES say, relative to PREFIX, where scripts and package go.
# All is made below BUILD first. A list of what was installed stays in PACKAGES: uninstall.sh and the next
# installation remove what is on it, and nothing else.
set -eu
python=$1 build=$2 objects=$3 libraries=$4 compiler=$5 prefix=$6 scripts=$7 packages=$8
here=$(dirname "$0")

refuse() {
    echo "install: $1" >&2
    exit 2
}

[ -n "$prefix" ] || refuse 'PREFIX is empty.'
[ "$(printf '%s' "$prefix" | wc -l)" = 0 ] || refuse 'PREFIX has more than one line.'
found=$(command -v "$python") || refuse "there is no Python called $python."
case $found in /*) python=$found ;; *) python=$PWD/$found ;; esac
case $python in *[\"\$\`\\]*) refuse "a script cannot name the Python $python." ;; esac
prefix=$(realpath -m -s -- "$prefix")
tree=$build/installed/tree
list=$packages/installed.list

rm -rf "$tree"
install -D -m 755 "$build/rattle" "$tree/$scripts/rattle"
package=$tree/$packages/rattle
mkdir -p "$package"
tar -C scripts/rattle --dereference --exclude=__pycache__ --exclude='*.so' -cf - . | tar -C "$package" -xf -
cp input/KEYS.md "$package/keys.md"
install -D -m 644 input/KEYS.md "$tree/share/doc/rattle/keys.md"
scripts/build_kernels.sh "$python" "$build/installed" "$objects" "$libraries" "$compiler" "$build" "$package"
# Linux itself takes no blank and no more than 127 characters here; the shell reads the second line then, and to Python
# this and the third are the beginning of the text that says what the script does.
case $python in
    *[[:space:]]*) plain= ;;
    *) plain=yes ;;
esac
[ "${#python}" -lt 126 ] || plain=
for name in calibrate campaign classify compare countermeasures export gear_data listen plot recording report sensitivity; do
    {
        if [ "$plain" ]; then
            printf '#!%s\n' "$python"
        else
            printf "#!/bin/sh\n'''exec' \"%s\" \"\$0\" \"\$@\"\n' ''' \\\\\n" "$python"
        fi
        tail -n +2 "scripts/$name.py"
    } > "$tree/$packages/$name.py"
    chmod 755 "$tree/$packages/$name.py"
    ln -sT "$(realpath -s --relative-to="$tree/$scripts" "$tree/$packages")/$name.py" "$tree/$scripts/rattle-$name"
done
page=$tree/share/man/man1/rattle.1
completion=$tree/share/bash-completion/completions/rattle
mkdir -p "$(dirname "$page")" "$(dirname "$completion")"
"$python" scripts/manual.py man "$build/rattle" > "$page"
"$python" scripts/manual.py bash "$build/rattle" > "$completion"

# Each line: a checksum and a file or link, or a folder that was not there before.
(cd "$tree" && find . -mindepth 1 \( -type f -o -type l \) -printf '%P\n' | sort) > "$build/installed/files"
: > "$build/installed/list"
while IFS= read -r file; do
    printf '%s  %s\n' "$("$here/file_sum.sh" "$tree/$file")" "$file"
done < "$build/installed/files" > "$build/installed/list"
{
    [ -d "$prefix" ] || echo .
    (cd "$tree" && find . -mindepth 1 -type d -printf '%P\n' | sort) | while IFS= read -r folder; do
        [ -d "$prefix/$folder" ] || printf '%s\n' "$folder"
    done
    if [ -e "$prefix/$list" ]; then sed -n 's/^folder  //p' "$prefix/$list"; fi
} | sort -u | sed 's/^/folder  /' >> "$build/installed/list"

if [ -e "$prefix/$list" ]; then "$here/uninstall.sh" "$prefix" "$packages" > "$build/installed/removed"; fi
while IFS= read -r file; do
    mkdir -p "$(dirname "$prefix/$file")"
    if [ -L "$tree/$file" ]; then
        ln -sfT "$(readlink "$tree/$file")" "$prefix/$file"
    elif [ -x "$tree/$file" ]; then
        install -m 755 -T "$tree/$file" "$prefix/$file"
    else
        install -m 644 -T "$tree/$file" "$prefix/$file"
    fi
done < "$build/installed/files"
install -m 644 -T "$build/installed/list" "$prefix/$list"
