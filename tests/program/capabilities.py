"""Small cases of all capabilities, for tests that hold for each of them: on ranks without cells, after a restart.

A case is options and a history of a contact on a row of cells in plane strain, or on 16 x 3 cells. The history has
three rows, of which the last one unloads. Each case differs from friction on a ball or cylinder by what its name says.
"""

from support import bodies

# 3 rows of 16 cells for a ball; a row of 24 cells for a cylinder
BALL = dict(
    **bodies(),
    gap_type="sphere",
    gap_radius1=0.2,
    gap_radius2=0.2,
    friction=0.3,
    grid_n=(16, 3),
    grid_size=(2.4e-3, 4.5e-4),
    allow_edge_contact=True,
    output_fields="all",
    steps=2,
)
LINE = dict(
    **bodies(),
    elasticity="plane",
    gap_type="curved",
    gap_radius1_x=0.2,
    gap_radius2_x=0.2,
    friction=0.3,
    grid_n=24,
    grid_size=2.4e-3,
    output_fields="all",
    steps=2,
)
LOAD = {False: 300.0, True: 2e5}  # N, N/m: half widths of 0.5 to 0.6 mm
YIELD = {False: 4e8, True: 1e8}
DISSIMILAR = dict(body2_young=70e9, body2_poisson=0.34)
LAYER = dict(body2_layer_young=4e11, body2_layer_poisson=0.25, body2_layer_thickness=1e-4)
HARDENING = dict(body2_hardening="linear:5e9")


def cases(plane):
    """{name: (options, columns)}: columns of the history beside time and load_n, as values of its first two rows."""
    shear = {"load_tx": (0.0, 0.2 * LOAD[plane])}
    strain = dict(body2_yield=YIELD[plane], yield_layers=6, **HARDENING)
    found = {
        "friction": ({}, shear),
        "pressed": ({}, {}),
        "dissimilar": (DISSIMILAR, shear),
        "dissimilar pressed": (DISSIMILAR, {}),
        "rigid": (dict(body1_young="inf", body1_poisson=None), shear),
        "hardness": (dict(pressure_limit=4e8 if not plane else 2e8), shear),
        "bulk stress": ({}, {**shear, "bulk2_stress_xx": (0.0, 5e7)}),
        "film": (dict(film_thickness=1e-6, film_shear=1e9), shear),
        "layers": (LAYER, shear),
        "yield": (strain, shear),
        "yield pressed": (strain, {}),
        "both yield": (dict(strain, body1_yield=YIELD[plane]), shear),
        "backstress": (dict(strain, body2_backstress=(1e10, 100.0)), shear),
        "yield, dissimilar": (dict(strain, **DISSIMILAR), shear),
        "yield and wear": (dict(strain, wear_coefficient2=1e-12), shear),
        "wear": (dict(wear_coefficient1=1e-12, wear_coefficient2=3e-12), shear),
        "wear by energy": (dict(wear_energy1=1e-12), shear),
        "sums": (dict(sum_slip_path=True, sum_friction_energy=True), shear),
        "slip path": (dict(friction_law="slip_path", friction_path_final=0.5, friction_path_length=1e-7), shear),
        "pressure law": (
            dict(friction_law="pressure", friction_pressure_exponent=-0.2, friction_pressure_reference=3e8),
            shear,
        ),
        "slide": (dict(slide=True, wear_coefficient1=1e-12), {"disp_x": (0.0, 3e-5)}),
        "slide and yield": (dict(strain, slide=True), {"disp_x": (0.0, 3e-5)}),
        "roll": ({}, {**shear, "roll": (0.0, 1.5e-4)}),
        "roll and yield": (strain, {**shear, "roll": (0.0, 1.5e-4)}),
        "steady rolling": (dict(rolling="steady", steps=None), {"creep_x": (5e-5, 1e-4)}),
        "stiffness": (dict(stiffness=True), shear),
        "stiffness, dissimilar": (dict(DISSIMILAR, stiffness=True), shear),
        "spots": (dict(contact_spots=True), shear),
        "moments": ({}, {**shear, "load_my": (0.0, 1e-5 * LOAD[plane])}),
        "displacement": ({}, {"disp_x": (0.0, 3e-7)}),
        "divided steps": (dict(step_rtol=0.05), shear),
        "periodic": (dict(elasticity="plane_periodic" if plane else "periodic"), shear),
        "periodic yield": (dict(strain, elasticity="plane_periodic" if plane else "periodic"), shear),
        "single precision": (dict(output_single=True), shear),
        "cycles of wear": (dict(wear_coefficient1=1e-14, wear_cycles=20, wear_jump=5, steps=1), None),
        "cycles of wear and yield": (dict(strain, wear_coefficient1=1e-14, wear_cycles=20, wear_jump=5, steps=1), None),
    }
    if plane:
        found["errors"] = (dict(errors="companion"), shear)
    else:
        found["yield below layers"] = (dict(strain, **LAYER), shear)
        found["twist"] = ({}, {**shear, "load_mz": (0.0, 5e-3)})
        found["oblique"] = ({}, {**shear, "load_ty": (0.0, 15.0)})
        found["roll across"] = ({}, {**shear, "roll_y": (0.0, 1e-4)})
    return found


def write(plane, options, columns, folder):
    """Options of a run with its history written into the folder."""
    load, base = LOAD[plane], LINE if plane else BALL
    rows = {"load_n": (load, load, 0.9 * load)}
    rows.update({name: (*values, 0.6 * values[1]) for name, values in (columns or {}).items()})
    if columns is None:  # a closed cycle
        t = 0.2 * load
        rows = {"load_n": (load,) * 5, "load_tx": (0.0, t, 0.0, -t, 0.0)}
    count = len(rows["load_n"])
    text = ",".join(["time", *rows]) + "\n"
    for k in range(count):
        text += ",".join(repr(float(v)) for v in (k + 1, *(values[k] for values in rows.values()))) + "\n"
    (folder / "history.csv").write_text(text)
    return {**base, "history": "history.csv", **options}
