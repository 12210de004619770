# Completion of the long options of petsam-plot and the other scripts and of their words, for bash: from what they say by
# --help, asked for once in a shell. All else is completed as a file's name. `make install` installs it by each name.

_petsam_tool()
{
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} tool=${1##*/} kept word

  # behind -- petsam-study takes petsam's options
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == -- ]]; then
      declare -F _petsam >/dev/null || . "${BASH_SOURCE[0]%/*}/petsam" 2>/dev/null
      ! declare -F _petsam >/dev/null || _petsam
      return
    fi
  done
  kept=_petsam_help_of_${tool//-/_}
  [[ ${!kept} ]] || declare -g "$kept=$(COLUMNS=200 "$1" --help 2>/dev/null)"
  if [[ $current == -* ]]; then
    # at the beginning of a line, maybe behind a short form
    word=$(sed -nE 's/^  (-[a-z]( [^ ]+)?, )?(--[a-z][a-z0-9-]*).*/\3/p' <<<"${!kept}")
    mapfile -t COMPREPLY < <(compgen -W "$word" -- "$current")
  elif [[ $before == --* && ${!kept} =~ "$before "\{([^\}]*)\} ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${BASH_REMATCH[1]//,/ }" -- "$current")
  fi
}
complete -o default -F _petsam_tool "${BASH_SOURCE[0]##*/}"
