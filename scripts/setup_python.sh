#!/bin/sh
# Makes a Python environment of this folder. Usage: setup_python.sh ENVIRONMENT [REQUIREMENTS]
set -eu
environment=$1
requirements=${2:-scripts/requirements.txt}

echo "installing Python packages into $environment"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
"$environment/bin/python" -m pip install --quiet --disable-pip-version-check --no-input -r "$requirements"
touch "$environment/installed"
