#!/usr/bin/env bash
# Lists the files that do not follow .clang-format. `contrib/check_format.sh --fix` mends them.
set -euo pipefail

cd "$(dirname "$0")/.."
wanted=14
version=$(clang-format --version | sed -nE 's/.*version ([0-9]+).*/\1/p')
mode=(--dry-run --Werror)
if [ "${1:-}" = --fix ]; then
  mode=(-i)
fi
# Another version lays out some lines in another way, although no one has touched them.
if [ "$version" != "$wanted" ]; then
  reason="the layout is that of clang-format $wanted, and here is version $version."
  if [ "${1:-}" = --fix ]; then
    echo "Nothing is mended: $reason" >&2
    exit 1
  fi
  echo "The layout is not checked: $reason"
  exit 0
fi
find include source applications tests contrib -name '*.h' -o -name '*.cc' | sort |
  xargs clang-format --style=file "${mode[@]}"
