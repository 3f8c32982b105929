#!/usr/bin/env bash
# Lists the files that do not follow .clang-format. `contrib/check_format.sh --fix` mends them.
set -euo pipefail

cd "$(dirname "$0")/.."
mode=(--dry-run --Werror)
if [ "${1:-}" = --fix ]; then
  mode=(-i)
fi
find include source applications tests contrib -name '*.h' -o -name '*.cc' | sort |
  xargs clang-format --style=file "${mode[@]}"
