#compdef orrery
# Zsh completion of orrery: commands, then the flags in the help of the command, else files.
if (( CURRENT == 2 )); then
  compadd -- ${(f)"$(orrery --help 2>/dev/null | sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')"}
elif [[ $words[CURRENT] == -* ]]; then
  compadd -- ${(f)"$(orrery help $words[2] 2>/dev/null | grep -o -- '--[a-z][a-z-]*' | sort -u)"}
else
  _files
fi
