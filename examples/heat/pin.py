"""A pin that slides on a disc: how its own heat changes the contact, with and without thermal expansion.

build/venv/bin/python examples/heat/pin.py
"""

import petsam

PIN = dict(
    body1="steel", body2="steel", gap_type="sphere", gap_radius1=0.2, gap_radius2="inf", load_n=200, friction=0.3,
    grid_n=96, grid_size=2.4e-3, heat="steady", errors="none",
)  # fmt: skip
EXPANSION = dict(body1_expansion=12e-6, body2_expansion=12e-6)  # 1/K
WAY = 0.1e-3  # m in each of two steps, the second of which slides from its beginning


def slide(speed, **more):
    """The pin stands, the disc moves to +x at a speed, m/s."""
    history = {"time": [WAY / speed, 2 * WAY / speed], "disp_x": [-WAY, -2 * WAY]}
    return petsam.run(**PIN, **more, body2_speed=speed, history=history)


def numbers(run):
    """The maximum temperature, K, the maximum pressure, MPa, and the area, mm2."""
    return (f"{run['temperature_max'][-1]:11.4g} {1e-6 * run['pressure_max'][-1]:11.4g} "
            f"{1e6 * run['contact_area'][-1]:10.4f}")  # fmt: skip


def main():
    columns = "maximum, K  p max, MPa  area, mm2"
    print(f"speed, m/s  power, W  {columns} | expands: {columns}  bulge, um")
    for speed in (0.03, 0.1, 0.3, 1, 2):
        with slide(speed) as cold, slide(speed, **EXPANSION) as hot:
            print(f"{speed:10g} {cold['heat_power'][-1]:9.4g} {numbers(cold)}  | {numbers(hot):>42} "
                  f"{1e6 * hot['thermal_displacement_max'][-1]:10.3f}")  # fmt: skip


if __name__ == "__main__":
    main()
