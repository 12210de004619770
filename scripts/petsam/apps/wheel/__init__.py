"""Wheel and rail: from two profiles to patches, creepages and forces at one position of a wheelset on its track.

    from petsam import wheel
    rail = wheel.Track(wheel.read("uic60.prr"), gauge=1.435, gauge_height=0.014)
    running = wheel.Wheelset(wheel.read("s1002.prw"), radius=0.46, flange_back=1.36, flange_position=-0.07)
    found = wheel.solve(rail, running, wheel.Position(y=2e-3, yaw=4.8e-3, speed=2.0), force=10e3, friction=0.3)
    print(found.force, [(patch.y, patch.angle, patch.n, patch.p_max) for patch in found.patches])

read        a Profile from a file of SIMPACK (.prr, .prw), of MiniProf (.whl, .ban, .mpt) or from columns
s1002       the wheel profile of UIC 510-2, by its formula; uic60, the rail's head by its arcs
Track       a rail profile in its place; Roller: a roller of a test rig instead
Wheelset    a wheel profile in its place
Position    position and speeds of the wheelset
Axle        both wheels: roll and height from the equilibrium under a Load; Vehicle: many positions, by solve_all
geometry    contact points and rolling radii of rigid wheels over y; equivalent_conicity of EN 15302
solve       one position: Result with its patches; Pair solves several positions with the same two profiles

profile     points of a profile, its smoothing, turning and mirror image
reading     which reader a file needs; simpack, miniprof, columns: the readers
standard    profiles by the formulas of their standards
section     the visible part of a profile as a function z(y)
rails       rails and rollers in their places; their level functions; leaning: of rails that are turned or mirrored
wheelset    wheels in their places; checks: of what rails and wheels are given
pose        position, speeds and rotation of the wheelset
locus       the line of the wheel that can touch
patches     regions of overlap and their frames
gap         the separation of the undeformed bodies on a patch's grid
creepages   creepages of a patch
contacts    contacts in process, kept by their grids
positions   the solution at a position
result      what solve() returns
axle        a wheelset on both rails: rigid, and in equilibrium at a displacement or under a lateral force
search      the iteration for an equilibrium; equilibrium: what it is of, and what it gives
lifting     why there is no equilibrium
derailing   wheels that climb: Y/Q beside Nadal's limit
spectrum    table of positions
batch       many positions in processes
conicity    geometry of rigid wheels, equivalent conicity
wearing     wear of a wheel's profile by a spectrum of positions
creep       the table of creep forces of elliptic contacts, CreepTable

Axes: x forward, y to the right, z down; z = 0 is the plane on the rails' tops, y = 0 the middle of the track. Profiles
have y to the field side and z down, of both bodies. SI units, angles in rad.
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={
        "profile": ("Profile", "ProfileWarning"),
        "reading": ("read",),
        "standard": ("s1002", "uic60"),
        "rails": ("Roller", "Track"),
        "wheelset": ("Wheelset",),
        "pose": ("Position",),
        "contacts": ("Material", "Settings"),
        "positions": ("Pair", "solve"),
        "result": ("ConformalWarning", "DerailWarning", "Patch", "Result"),
        "axle": ("Axle",),
        "equilibrium": ("Equilibrium", "Load"),
        "spectrum": ("State", "read_positions"),
        "batch": ("Vehicle", "solve_all"),
        "conicity": ("equivalent_conicity", "geometry"),
        "wearing": ("Worn", "wear"),
        "creep": ("CreepTable", "FallingFriction"),
    },
    libraries=("numpy", "h5py", "matplotlib", "scipy"),
    pictures={"pictures": ("over_y", "wheels", "worn_profile")},
)
__all__, __getattr__, __dir__ = PART.face()
