#!/usr/bin/env python3
"""Writes bash's completion of the options of petsam or petsam-stress, from its -help.

    python3 scripts/maintain/completion.py build/bin/petsam > share/bash-completion/completions/petsam

`make install` does it. The file needs bash only; `. file` is enough where bash-completion is not installed.
"""

import sys

import options

FUNCTION = r"""# Completion of the options of {program} {version} and of their words, for bash. Made by completion.py.

{function}()
{{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
  local options="{options}"
  local words="" more=$options done=""

  # what the option before takes: `words`, and `more` if its value may be left out
  case $before in
{cases}
  esac
  if [[ $more == list ]]; then
    # several words with commas between them: the last one is completed, of those that are not there yet
    [[ $current == *,* ]] && done=${{current%,*}},
    for more in $words; do
      [[ ,$done != *,$more,* && $done$more == "$current"* ]] && COMPREPLY+=("$done$more")
    done
    compopt -o nospace 2>/dev/null
  elif [[ $more == file ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
    compopt -o filenames 2>/dev/null
  else
    # where a value may be left out, an option begins with its dash
    [[ $words && $current != -* ]] && more=""
    mapfile -t COMPREPLY < <(compgen -W "$words $more" -- "$current")
  fi
}}
complete -F {function} {program}
"""


def value_of(option, topics):
    """Returns new values of the function's variables after an option; None: no change, as after any other word."""
    words = " ".join(option.words)
    if option.name == "-help":
        return f'words="{" ".join(topics)}"'
    if option.argument == "<file>":
        return "more=file"
    if option.argument.endswith(",...]") and words:
        return f'words="{words}" more=list'
    if option.argument.startswith("["):
        return f'words="{words}"' if words else None
    return f'words="{words}" more=""' if option.argument else None


def completion(described):
    program = described["program"]
    topics = [topic["name"].replace(" ", "_") for topic in described["topics"]] + ["json"]
    listed = [option for group in options.groups_of(described) for option in group.options]
    names = {}
    for option in listed:
        names.setdefault(value_of(option, topics), []).append(option.name)
    cases = [f"  {' | '.join(group)}) {value} ;;" for value, group in names.items() if value]
    return FUNCTION.format(
        program=program,
        version=described["version"],
        function="_" + program.replace("-", "_"),
        options=" ".join(option.name for option in listed),
        cases="\n".join(cases),
    )


if __name__ == "__main__":
    print(completion(options.read_or_end(sys.argv[1])), end="")
