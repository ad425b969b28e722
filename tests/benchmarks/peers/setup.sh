#!/bin/sh
# Make the venv of the bench's peers: setup.sh FOLDER
# A peer that cannot be installed is reported and skipped; the bench runs without it.
set -u
if [ $# -ne 1 ]; then
   echo "usage: $0 FOLDER" >&2
   exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
missing=""

if [ ! -x "$folder/bin/python" ]; then
   python3 -m venv "$folder" || { echo "no Python venv in $folder: no peers" >&2; exit 1; }
fi

# One by one, so that one package that fails does not take the others with it.
while read -r package; do
   case $package in '' | '#'*) continue ;; esac
   "$folder/bin/pip" install -q --disable-pip-version-check "$package" || missing="$missing $package"
done <"$here/requirements.txt"

have_cvode() {
   printf '#include <cvode/cvode.h>\nint main(void) { return 0; }\n' |
      gcc -x c - -o /dev/null -lsundials_cvode -lsundials_nvecserial 2>/dev/null
}

if ! have_cvode; then
   if [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null; then
      { apt-get update -qq && apt-get install -y -qq libsundials-dev gcc >/dev/null; } || true
   else
      echo "not root: libsundials-dev and gcc are not installed from here" >&2
   fi
   have_cvode || missing="$missing libsundials-dev"
fi

if [ -n "$missing" ]; then
   echo "peers skipped, not installable:$missing" >&2
else
   echo "all peers installed in $folder"
fi
