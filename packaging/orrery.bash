# Bash completion of orrery: commands, then the flags in the help of the command, else files.
_orrery() {
  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} help
  if [ "$COMP_CWORD" = 1 ]; then
    help=$(orrery --help 2>/dev/null | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
  elif [[ $word == -* ]]; then
    help=$(orrery help "$command" 2>/dev/null | grep -o -- '--[a-z][a-z-]*' | sort -u)
  fi
  if [ -n "$help" ]; then
    mapfile -t COMPREPLY < <(compgen -W "$help" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _orrery orrery
