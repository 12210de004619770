"""Names and symbols of known quantities in pictures; all others in a file go by their own names."""

from .units import plain

SYMBOLS = {
    "load_n": "$N$", "load_tx": "$T_x$", "load_ty": "$T_y$", "load_mx": "$M_x$", "load_my": "$M_y$", "load_mz": "$M_z$",
    "disp_z": "$d_z$", "disp_x": "$d_x$", "disp_y": "$d_y$", "rot_x": "$r_x$", "rot_y": "$r_y$", "rot_z": "$r_z$",
    "creep_x": r"creepage $\xi$", "creep_y": r"creepage $\eta$", "creep_spin": r"spin $\varphi$",
    "dissipated_energy": "dissipated energy, sum",
    "wear_volume1": "volume removed of body 1", "wear_volume2": "volume removed of body 2",
}  # fmt: skip
FIELDS = {
    "pressure": ("pressure", "$p$"), "shear": ("shear", "$|q|$"), "slip": ("slip", "$|s|$"),
    "shear_x": ("shear", "$q_x$"), "shear_y": ("shear", "$q_y$"), "slip_x": ("slip", "$s_x$"),
    "slip_y": ("slip", "$s_y$"), "state": ("state", ""), "gap": ("gap", "$g$"),
    "slip_range": ("slip range of the cycle", ""), "slip_amplitude": ("slip amplitude of the cycle", ""),
    "slip_velocity": ("slip velocity over $V$,", "$|s|$"),
     "power_density": ("power density over $V$,", r"$-q \cdot s$"),
    "wear_depth1": ("depth removed of body 1,", "$w_1$"), "wear_depth2": ("depth removed of body 2,", "$w_2$"),
}  # fmt: skip


def scalar(name):
    """Returns the name of a dataset of /history in pictures."""
    if name.count(".") == 2:  # an entry of a matrix
        matrix, load, way = name.split(".")
        return f"{scalar(matrix)}, d{SYMBOLS[load]}/d{SYMBOLS[way]}"
    return SYMBOLS.get(name) or plain(name.replace("_", " "))


def field(results, name):
    """Title and symbol, if it has one, of a field of the file, and its unit."""
    unit, text = results.about(name)
    if name in FIELDS:
        title, symbol = FIELDS[name]
        if "at its own points" in text:  # not at the cells, which go with the contact
            title += " at its own points,"
        return f"{title} {symbol}".strip(), symbol, unit
    if name not in results.fields:  # the magnitude of a vector
        text = name.replace("_", " ") + ", magnitude"
    return plain(text), "", unit
