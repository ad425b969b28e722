#!/bin/sh
# The checksum of a file, or of the text of a link. Usage: file_sum.sh FILE
set -eu
if [ -L "$1" ]; then readlink -n "$1" | sha256sum; else sha256sum < "$1"; fi | cut -d' ' -f1
