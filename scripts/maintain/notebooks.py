"""Writes a notebook of examples/notebooks as a page of Markdown with the pictures that are stored in it."""

import base64
import functools
import json


def _fenced(word, text):
    return f"```{word}\n{text.rstrip()}\n```\n"


@functools.cache
def page(path):
    """Returns the Markdown of a notebook and its pictures, {name of a file beside the page: bytes}."""
    parts, pictures = [], {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        parts.append(_fenced("python", source) if cell["cell_type"] == "code" else source + "\n")
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "image/png" in data:
                name = f"{path.stem}-{len(pictures) + 1}.png"
                pictures[name] = base64.b64decode("".join(data["image/png"]))
                parts.append(f"![Picture {len(pictures)} of the notebook]({name})\n")
            else:
                parts.append(_fenced("text", "".join(output.get("text") or data["text/plain"])))
    return "\n".join(parts), pictures
