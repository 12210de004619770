"""Keywords of decks: those that are read, with their parameters, those that have no effect here, and what replaces the
others."""

import difflib

from ...core.errors import Error, nearest, short

# keywords that are read, with the parameters that are understood or have no effect
READ = {
    "ASSEMBLY": ("NAME",),
    "BOUNDARY": ("OP", "TYPE"),
    "CLOAD": ("OP",),
    "DENSITY": (),
    "DLOAD": ("OP",),
    "DSLOAD": ("OP",),
    "ELASTIC": ("TYPE",),
    "ELEMENT": ("ELSET", "TYPE"),
    "ELSET": ("ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED"),
    "END ASSEMBLY": (),
    "END INSTANCE": (),
    "END PART": (),
    "END STEP": (),
    "INSTANCE": ("NAME", "PART"),
    "MATERIAL": ("NAME",),
    "NODE": ("NSET", "SYSTEM"),
    "NSET": ("ELSET", "GENERATE", "INSTANCE", "INTERNAL", "NSET", "UNSORTED"),
    "PART": ("NAME",),
    "SOLID SECTION": ("CONTROLS", "ELSET", "MATERIAL"),
    "STEP": None,  # of all: the load case is its linear response
    "SURFACE": ("INTERNAL", "NAME", "TYPE"),
}
VALUES = {  # the values of parameters that mean what is read
    ("BOUNDARY", "TYPE"): ("DISPLACEMENT",),
    ("NODE", "SYSTEM"): ("R",),
    ("SURFACE", "TYPE"): ("ELEMENT", "NODE"),
}
LOADS = ("CLOAD", "DLOAD", "DSLOAD", "BOUNDARY")
IN_STEPS = ("NSET", "ELSET")  # of those that are read: also between *STEP and *END STEP


def _names(text):
    """The keywords of a list."""
    return {name.strip() for line in text.splitlines() for name in line.split(",")} - {""}


# keywords that change neither the mesh nor its supports, materials and loads: output, procedures, contact (which is
# petsam's), and what materials do beside their elasticity
IGNORED = _names("""
    HEADING, PREPRINT, RESTART, PHYSICAL CONSTANTS, AMPLITUDE, TIME POINTS, FILTER, DIAGNOSTICS, MONITOR, PRINT
    INITIAL CONDITIONS, SECTION CONTROLS
    OUTPUT, NODE OUTPUT, ELEMENT OUTPUT, CONTACT OUTPUT, ENERGY OUTPUT, INTEGRATED OUTPUT, INTEGRATED OUTPUT SECTION
    INCREMENTATION OUTPUT, MODAL OUTPUT, SURFACE OUTPUT, NODE PRINT, NODE FILE, EL PRINT, EL FILE, ELEMENT FILE
    CONTACT PRINT, CONTACT FILE, ENERGY PRINT, ENERGY FILE, FACE PRINT, SECTION PRINT, SECTION FILE, MODAL PRINT
    MODAL FILE, FILE FORMAT, FILE OUTPUT, ELEMENT MATRIX OUTPUT
    STATIC, FREQUENCY, DYNAMIC, BUCKLE, VISCO, MODAL DYNAMIC, STEADY STATE DYNAMICS, COMPLEX FREQUENCY, HEAT TRANSFER
    COUPLED TEMPERATURE-DISPLACEMENT, UNCOUPLED TEMPERATURE-DISPLACEMENT, CONTROLS, SOLVER CONTROLS, STEP CONTROLS
    SELECT EIGENMODES, MODAL DAMPING, GLOBAL DAMPING, RETAINED NODAL DOFS, SUBSTRUCTURE GENERATE
    SUBSTRUCTURE MATRIX OUTPUT, NO ANALYSIS
    CONTACT, CONTACT PAIR, CONTACT INCLUSIONS, CONTACT EXCLUSIONS, CONTACT PROPERTY ASSIGNMENT, CONTACT CONTROLS
    CONTACT INITIALIZATION ASSIGNMENT, CONTACT INITIALIZATION DATA, CONTACT CONTROLS ASSIGNMENT, CONTACT FORMULATION
    CONTACT STABILIZATION, CONTACT DAMPING, CLEARANCE, SURFACE INTERACTION, SURFACE BEHAVIOR
    SURFACE PROPERTY ASSIGNMENT, FRICTION, CHANGE FRICTION, GAP CONDUCTANCE, GAP HEAT GENERATION
    PLASTIC, CYCLIC HARDENING, EXPANSION, CONDUCTIVITY, SPECIFIC HEAT, DAMPING, DEPVAR, CREEP, ANNEAL TEMPERATURE
""")  # fmt: skip
GLUES = ("TIED", "NO SEPARATION")  # words by which contact holds bodies together

WRITE_OUT = "write all nodes and elements by *NODE and *ELEMENT, in x, y, z of the whole deck"
WITHOUT = "remove it, and mesh the body without it"
ISOTROPIC = "give *ELASTIC with E and nu"
BY_FIXED = "hold the body by --fixed or --symmetry instead"
REPLACED = {  # what to do about other keywords that change a body or its loads
    WRITE_OUT: """NGEN, NFILL, NCOPY, NMAP, ELGEN, ELCOPY, SYSTEM, TRANSFORM, PARAMETER, IMPERFECTION, ELSET GENERATE
        IMPORT, IMPORT NODESET, IMPORT ELSET, MAP SOLUTION, SUBMODEL, CYCLIC SYMMETRY MODEL, SYMMETRIC MODEL GENERATION
        ADAPTIVE MESH, REFINE MESH, DISTRIBUTION, DISTRIBUTION TABLE, NODAL THICKNESS""",
    WITHOUT: """BEAM SECTION, BEAM GENERAL SECTION, SHELL SECTION, SHELL GENERAL SECTION, MEMBRANE SECTION
        SURFACE SECTION, COHESIVE SECTION, COHESIVE BEHAVIOR, GASKET SECTION, GASKET BEHAVIOR, TRUSS SECTION
        CONNECTOR SECTION, CONNECTOR BEHAVIOR, CONNECTOR ELASTICITY, CONNECTOR LOAD, CONNECTOR MOTION
        COUPLING, DISTRIBUTING COUPLING, DISTRIBUTING, KINEMATIC COUPLING, KINEMATIC, EMBEDDED ELEMENT, FASTENER
        FASTENER PROPERTY, EQUATION, MPC, TIE, RIGID BODY, RIGID SURFACE, SHELL TO SOLID COUPLING
        SPRING, DASHPOT, GAP, MASS, ROTARY INERTIA, NONSTRUCTURAL MASS, POINT MASS, BUSHING, JOINT, JOINTED MATERIAL
        REBAR, REBAR LAYER, SUBSTRUCTURE, SUBSTRUCTURE PROPERTY, USER ELEMENT, UEL PROPERTY, MATRIX INPUT
        MATRIX ASSEMBLE, PRE-TENSION SECTION, RELEASE, MODEL CHANGE, CRACK GROWTH, DEBOND, ENRICHMENT
        INTEGRATED ASSEMBLY, NETWORK MPC, FLUID SECTION, FLUID CAVITY, STIFFENER""",
    ISOTROPIC: """ORIENTATION, NO COMPRESSION, NO TENSION, HYPERELASTIC, HYPERFOAM, HYPOELASTIC, POROUS ELASTIC
        VISCOELASTIC, ANISOTROPIC HYPERELASTIC, DEFORMATION PLASTICITY, FAIL STRAIN, FAIL STRESS, USER MATERIAL
        MOHR COULOMB, DRUCKER PRAGER, CAP PLASTICITY, CONCRETE, CAST IRON PLASTICITY, CLAY PLASTICITY, SUPERELASTIC
        CONCRETE DAMAGED PLASTICITY, DAMAGE INITIATION, DAMAGE EVOLUTION, EOS, PIEZOELECTRIC, SECTION ORIENTATION""",
    BY_FIXED: "FOUNDATION, BASE MOTION, INERTIA RELIEF, SECONDARY BASE, SUPPORT",
    "remove it": """TEMPERATURE, CFLUX, DFLUX, DSFLUX, FILM, SFILM, RADIATE, SRADIATE, FIELD, PRESSURE STRESS
        CHANGE CONTACT PAIR, CONTACT INTERFERENCE, GRAVITY, CECHARGE, DECHARGE""",
}  # fmt: skip
CURES = {name: cure for cure, names in REPLACED.items() for name in _names(names)}


def _squeezed(name):
    """A keyword without blanks, which CalculiX does not need."""
    return name.replace(" ", "")


KNOWN = {_squeezed(name): name for name in (*CURES, *IGNORED, *READ)}


def known(card):
    """The full keyword of a card; raises Error, with the most similar one, if no manual has it."""
    name = KNOWN.get(_squeezed(card.name))
    if name is None:
        near = difflib.get_close_matches(card.name, (*READ, *IGNORED, *CURES), 2, 0.75)
        cure = f"is {' or '.join('*' + one for one in near)} meant? Correct it" if near else "correct or remove it"
        raise Error(f"{card.place}: *{short(card.name)} is not supported: {cure}")
    return name


def need_supported(card, where=""):
    """Raises Error if a card is one that changes the body or its loads and is not read."""
    if card.name in CURES:
        raise Error(f"{card.place}: *{card.name}{where} is not supported: {CURES[card.name]}")
    if card.name in IGNORED:
        words = {*card.parameters, *(str(value).upper() for value in card.parameters.values())}
        glue = next((word for word in GLUES if word in words), None)
        if glue:
            raise Error(f"{card.place}: {glue} of *{card.name} is not supported: remove it, and mesh the bodies joined")
    elif card.name not in LOADS:
        need_parameters(card)


def need_parameters(card):
    """Raises Error if a card has a parameter, or a value of one, that is not read."""
    names = READ[card.name]
    for name, value in card.parameters.items():
        if names is not None and name not in names:
            near = nearest(name, names)
            cure = f"is {near[0]} meant? Correct it" if near else _cure(name)
            raise Error(f"{card.place}: {short(name)} of *{card.name} is not supported: {cure}")
        values = VALUES.get((card.name, name))
        if values and value.upper() not in values:
            raise Error(
                f"{card.place}: {name}={short(value)} of *{card.name} is not supported: use {' or '.join(values)}"
            )


def _cure(parameter):
    """The cure for a parameter that is not read."""
    if parameter == "INPUT":
        return "name the file by *INCLUDE in the next line"
    if parameter == "AMPLITUDE":
        return "give the values themselves"
    return "remove it, and write out what it stands for"
