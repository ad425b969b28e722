#!/bin/sh
# Makes the Python environment of this folder. Usage: setup_python.sh ENVIRONMENT
set -eu
environment=$1

echo "installing Python packages into $environment"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
"$environment/bin/python" -m pip install --quiet --disable-pip-version-check --no-input -r scripts/requirements.txt
touch "$environment/installed"
