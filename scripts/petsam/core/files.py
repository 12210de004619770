"""Checks a name before it is opened: a pipe would wait for ever, and a device never ends. Reads texts."""

import codecs
import os
import stat

from .errors import FILE, Error, MissingFile

SAMPLE = 4096  # bytes of a file that show whether it is a text


def need_regular(path):
    """Returns the status of a regular file; raises MissingFile if there is none, and Error if it is not a regular file.

    Raises another OSError if the file cannot be reached.
    """
    try:
        status = os.stat(path)
    except FileNotFoundError:
        raise MissingFile(path) from None
    except ValueError as error:  # a NUL in the name
        raise Error(f"{path}: is no file's name") from error
    if stat.S_ISDIR(status.st_mode):
        raise Error(f"{path}: is a directory")
    if not stat.S_ISREG(status.st_mode):
        raise Error(f"{path}: is not a regular file")
    return status


def state_of(path):
    """Returns the numbers of a regular file that change when it is written to: device, inode, size and time; None if
    there is no such file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    regular = stat.S_ISREG(status.st_mode)
    return (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns) if regular else None


class Unwritable(Error):
    """A file that cannot be written."""

    code = FILE


def decoded(data):
    """Returns the text of bytes, without a byte order mark: UTF-16 with such a mark, UTF-8, or else Latin-1.

    Latin-1 makes each byte a letter of its own, so that names that differ in the file differ in the text.
    """
    try:
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return data.decode("utf-16")
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def text_of(path):
    """Returns the text of a regular file, with "\\n" at the ends of lines; raises Error if it has bytes of 0.

    Split it by "\\n": `splitlines` ends lines at letters, too, such as the dots of "1 ... 9" in Latin-1.
    """
    need_regular(path)
    with open(path, "rb") as file:
        start = file.read(SAMPLE)
        text = decoded(start)
        if "\0" not in text:
            text = decoded(start + file.read())
    if "\0" in text:
        raise Error(f"{path}: is no text, as it has bytes of 0: save it as a text in UTF-8")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def need_replaceable(path, inputs=(), error=None):
    """Raises Error if the name is not that of a regular file, and Unwritable if no file can be written there.

    Commands call it before their work, for each file that they will write. `inputs` are files that they read, or None:
    where the name is that of one of them, the error is raised.
    """
    if any(same(path, one) for one in inputs if one is not None):
        raise error or Error(f"{path}: is an input file; choose another name by --output")
    if os.path.lexists(path) and os.path.exists(path):
        need_regular(path)
        if not os.access(path, os.W_OK):
            raise Unwritable(f"{path}: cannot be written: permission denied; choose another name")
        return
    need_folder(os.path.dirname(os.path.realpath(path)), path)


def need_folder(folder, path):
    """Raises Unwritable for the file of this path if no file can be made in its folder."""
    reason = None
    if not os.path.lexists(folder):
        reason = f"its folder {folder} does not exist"
    elif not os.path.isdir(folder):
        reason = f"its folder {folder} is a file"
    else:
        trial = os.path.join(folder, f".petsam.{os.getpid()}.tmp")  # permissions alone do not tell, as of root
        try:
            os.close(os.open(trial, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
            os.remove(trial)
        except OSError as error:
            reason = f"its folder {folder}: {error.strerror or error}"
    if reason:
        raise Unwritable(f"{path}: cannot be written: {reason}; make it, or choose another name")


def same(one, other):
    """Returns true if two names belong to the same existing file."""
    try:
        return os.path.samefile(one, other)
    except OSError:
        return False
