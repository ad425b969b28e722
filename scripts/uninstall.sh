#!/bin/sh
# Removes what install.sh installed below a folder: the files on its list that are still as they were installed,
# what Python compiled of them, and folders that the installation made and nobody else uses.
# Usage: uninstall.sh PREFIX PACKAGES
set -eu
prefix=$1 packages=$2
here=$(dirname "$0")
list=$prefix/$packages/installed.list

if [ ! -f "$list" ] || [ -L "$list" ]; then
    echo "uninstall: there is no $list, so it is not known what was installed; nothing is removed." >&2
    exit 2
fi
if grep -qE '  (/|(.*/)?\.\.(/|$))' "$list"; then
    echo "uninstall: $list names places outside $prefix; nothing is removed." >&2
    exit 2
fi
grep -v '^folder  ' "$list" | while IFS= read -r line; do
    file=$prefix/${line#*  }
    if [ ! -e "$file" ] && [ ! -L "$file" ]; then continue; fi
    if [ -d "$file" ] && [ ! -L "$file" ] || [ "$("$here/file_sum.sh" "$file")" != "${line%%  *}" ]; then
        echo "kept, as it has changed since: $file"
        continue
    fi
    rm -f -- "$file"
    case $file in
        *.py)
            compiled=$(dirname "$file")/__pycache__
            if [ -d "$compiled" ]; then
                find "$compiled" -maxdepth 1 -type f -name "$(basename "$file" .py).*.pyc" -delete
                rmdir --ignore-fail-on-non-empty -- "$compiled"
            fi ;;
    esac
done
# The deepest first; a dot is the folder itself.
folders=$(sed -n 's/^folder  //p' "$list" | LC_ALL=C sort -r)
rm -f -- "$list"
printf '%s\n' "$folders" | while IFS= read -r name; do
    folder=$prefix/$name
    case $name in '') continue ;; .) folder=$prefix ;; esac
    if [ -d "$folder" ] && [ ! -L "$folder" ]; then rmdir --ignore-fail-on-non-empty -- "$folder"; fi
done
