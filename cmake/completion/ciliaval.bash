# bash completion of ciliaval; zsh loads it through bashcompinit. Commands and options are those that the program's own help names.
# SPDX-License-Identifier: LGPL-2.1-or-later
_ciliaval() {
  local word=${COMP_WORDS[COMP_CWORD]} command=
  [ "$COMP_CWORD" -gt 1 ] && command=${COMP_WORDS[1]}
  if [ -z "$command" ]; then
    local commands
    commands=$("${COMP_WORDS[0]}" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/ s/^  \([a-z]\+\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$commands --help --version" -- "$word")
  elif [[ $word == -* ]]; then
    local options
    options=$({ "${COMP_WORDS[0]}" "$command" --help; "${COMP_WORDS[0]}" --help; } 2>/dev/null | grep -oE '^  +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+' | sort -u)
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -X '!*.toml' -- "$word"; compgen -f -X '!*.csv' -- "$word"; compgen -d -S / -- "$word")
  fi
}
complete -o nospace -F _ciliaval ciliaval
