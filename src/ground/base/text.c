/* Messages, and parts of them: the prefix of options, and lists of names. */
#include <petsam/private/baseimpl.h>
#include <petsam/private/base.h>
#include <stdarg.h>
#include <stdio.h>

#define LONGEST 8192 /* characters of a message */

const char *SamOptionsPrefix(const SamOptions *from)
{
  return from->prefix ? from->prefix : "";
}

void SamJoin(PetscInt count, const char *const names[], const char between[], const char last[], char text[],
             size_t size)
{
  size_t used = 0;

  text[0] = '\0';
  for (PetscInt k = 0; k < count && used < size; k++)
    used += (size_t)snprintf(text + used, size - used, "%s%s", !k ? "" : k + 1 < count ? between : last, names[k]);
}

/*
  Returns how many bytes of UTF-8 end a line or control a terminal as one character, and its code: U+0080 to U+009F, and
  the separators of lines and of paragraphs; 0 if they do not.
*/
static int Controls(const unsigned char c[], unsigned *code)
{
  const PetscBool controls  = c[0] == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool separates = c[0] == 0xe2 && c[1] == 0x80 && (c[2] == 0xa8 || c[2] == 0xa9) ? PETSC_TRUE : PETSC_FALSE;

  *code = controls ? c[1] : separates ? 0x2000U + (c[2] & 0x3fU) : 0;
  return controls ? 2 : separates ? 3 : 0;
}

void SamOneLine(const char text[], char line[], size_t size)
{
  static const char letters[] = "abtnvfr"; /* of the characters from '\a' to '\r' */
  const size_t      longest   = sizeof("\\u2028") - 1;
  size_t            used      = 0;

  for (; *text && used + longest < size; text++) {
    const unsigned char c = (unsigned char)*text;
    unsigned            code;
    const int           bytes = Controls((const unsigned char *)text, &code);

    if (bytes)
      used += (size_t)snprintf(line + used, size - used, "\\u%04x", code);
    else if (c >= '\a' && c <= '\r')
      used += (size_t)snprintf(line + used, size - used, "\\%c", letters[c - '\a']);
    else if (c < ' ' || c == 0x7f)
      used += (size_t)snprintf(line + used, size - used, "\\x%02x", c);
    else
      line[used++] = *text;
    text += bytes ? bytes - 1 : 0;
  }
  line[used] = '\0';
}

void SamPrintMessage(const char program[], const char format[], ...)
{
  va_list values;
  char    text[LONGEST], line[LONGEST];

  va_start(values, format);
  (void)vsnprintf(text, sizeof(text), format, values);
  va_end(values);
  SamOneLine(text, line, sizeof(line));
  (void)fprintf(stderr, "%s: %s\n", program, line);
}

void SamNameSetting(const char text[], const char setting[], char line[], size_t size)
{
  char option[64] = "";

  if (setting[0]) (void)snprintf(option, sizeof(option), "-%s", setting);
  if (strstr(text, option))
    (void)snprintf(line, size, "%s", text);
  else
    (void)snprintf(line, size, "%s (%s)", text, option);
}
