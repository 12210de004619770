# Turns the text of a program's help, src/front/app/*.help, into C: the array `topics`, whose first is the usage.
# A line "== name: group; group" begins a topic, to which the options of these groups belong; empty lines before it
# separate only. @VERSION@ stands for the variable `version`.

function quote(text) {
  gsub(/\\/, "&&", text)
  gsub(/"/, "\\\"", text)
  return "\"" text "\""
}

BEGIN { printf "static const SamTopic topics[] = {{\"\", {NULL}" }

/^== / {
  groups = (colon = index($0, ": ")) ? substr($0, colon + 2) : ""
  count = split(groups, group, /; /)
  printf "},\n  {%s, {", quote(substr($0, 4, colon ? colon - 4 : length($0)))
  for (k = 1; k <= count; k++) printf "%s, ", quote(group[k])
  printf "NULL}"
  start = 1
  empty = 0
  next
}

/^$/ { empty++; next }

{
  if (FNR == 1 || start) printf ","
  for (start = 0; empty; empty--) printf "\n    \"\\n\""
  gsub(/@VERSION@/, version)
  printf "\n    %s \"\\n\"", quote($0)
}

END { print "},\n  {NULL, {NULL}, NULL}};" }
