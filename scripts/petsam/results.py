"""Reading of petsam's results files, of any size: scalars whole, fields by step, window and stride."""
import os

import h5py
import numpy as np

from figures import InputError

OPEN, STICK, SLIP = 0, 1, 2  # /state
BLOCK = 256  # rows read at a time: bounds the memory, and strides in HDF5 itself are slow


class Results:
    """One results file: x, y (m), history (dict of arrays, a value a load step), steps (numbers, from 1, of the saved
    fields), times (of the saved fields); InputError where it cannot be read."""

    def __init__(self, path, label=None):
        self.path = path
        self.label = label or os.path.splitext(os.path.basename(path))[0]
        try:
            self.file = h5py.File(path, "r")
            self.x, self.y, self.times = (self.file[name][:] for name in ("x", "y", "time"))
            self.history = {name: data[:] for name, data in self.file["history"].items()}
            self.units = {name: data.attrs["units"] for name, data in self.file["history"].items()}
            self.friction = float(self.file.attrs["friction"])
        except (OSError, KeyError) as error:
            raise InputError("{}: {}".format(path, _reason(error))) from error
        if not self.history["time"].size:
            raise InputError("{}: has no load step yet".format(path))
        at = np.argmin(np.abs(self.history["time"][:, None] - self.times[None, :]), axis=0)
        self.steps = [int(k) + 1 for k in at]

    def of_step(self, number):
        """Index into the fields of the load step number: from 1, or from the end, -1 being the last."""
        count = self.history["time"].size
        step = count + 1 + number if number < 0 else number
        if not self.steps:
            raise InputError("{}: no fields were saved".format(self.path))
        if not 1 <= step <= count:
            raise InputError("{}: --step {}: there are {} steps".format(self.path, number, count))
        if step in self.steps:
            return self.steps.index(step)
        raise InputError("{}: --step {}: its fields were not saved, those of steps {} were".format(
            self.path, number, _some(self.steps)))

    def of_time(self, time):
        """Index into the fields of the saved step nearest to time (s), which must lie between the first and the last."""
        if not self.steps:
            raise InputError("{}: no fields were saved".format(self.path))
        low, high = float(self.times[0]), float(self.times[-1])
        slack = 1e-9 * max(abs(low), abs(high))
        if not low - slack <= time <= high + slack:
            raise InputError("{}: --time {:g}: fields were saved from {:g} to {:g}".format(self.path, time, low, high))
        return int(np.argmin(np.abs(self.times - time)))

    def field(self, name, index, rows=slice(None), columns=slice(None), stride=1):
        """Field name (ny, nx) of a saved step on a window, every stride-th cell."""
        low, high, _ = rows.indices(self.y.size)
        try:
            data = self.file[name]
            block = stride * max(1, BLOCK // stride)
            parts = [data[index, k:min(k + block, high), columns][::stride, ::stride] for k in range(low, high, block)]
        except (OSError, KeyError) as error:
            raise InputError("{}: {}".format(self.path, _reason(error))) from error
        return np.concatenate(parts)

    def contact_window(self, index, margin=0.15):
        """Rows and columns (slices) of the smallest rectangle about the contact, and a margin; all without contact."""
        stride = max(1, max(self.x.size, self.y.size) // 1024)
        contact = self.field("state", index, stride=stride) != OPEN
        return tuple(_window(np.flatnonzero(contact.any(axis=axis)) * stride, stride, size, margin)
                     for axis, size in ((1, self.y.size), (0, self.x.size)))

    def title(self, index):
        """What names a saved step: the label, and the step and its time where there are several."""
        if self.history["time"].size == 1:
            return self.label
        return "{}, step {}, t = {:.4g} s".format(self.label, self.steps[index], self.times[index])


def _window(cells, stride, size, margin):
    if not cells.size:
        return slice(0, size)
    more = int(np.ceil(margin * (cells[-1] - cells[0] + stride))) + stride
    return slice(max(0, int(cells[0]) - more), min(size, int(cells[-1]) + stride + more))


def _some(numbers):
    words = [str(n) for n in numbers]
    return ", ".join(words if len(words) <= 8 else words[:4] + ["..."] + words[-2:])


def _reason(error):
    """The end of HDF5's chain of messages, in a line."""
    if isinstance(error, FileNotFoundError):
        return "no such file"
    text = str(error.args[0] if isinstance(error, KeyError) else error).replace("\n", " ")
    if "file signature not found" in text:
        return "is not an HDF5 file"
    if "unable to lock file" in text.lower():
        return "is being written by a run"
    return "is not a results file of petsam: " + text if isinstance(error, KeyError) else "cannot be read: " + text
