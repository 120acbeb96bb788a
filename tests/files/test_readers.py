"""What other programs find in a file: labels, units, and the numbers of the solution."""

import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import carom
from files.compare import derived_differences, differences
from files.made_up import parts_of

READER = """
import sys, h5py
sys.modules["carom"] = None  # not to be had here
with h5py.File(sys.argv[1]) as file:
    position = file["position"]
    print([scale[0].name for scale in position.dims], position.attrs["units"])
    print(file["body"].asstr()[0], file["impact_law"].asstr()[0], len(file["impact_time"]))
    print(repr(float(position[-1, 0, 2])), file.attrs["carom_version"], file.attrs["Conventions"])
"""


def test_xarray_reads_what_to_xarray_gives(run, request, saved, tmp_path):
    (tmp_path / "run.nc").write_bytes(saved[request.node.callspec.params["run"]])
    with xr.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as data:
        xr.testing.assert_identical(data.load(), run.to_xarray())


def test_dimensions_and_units(swung):
    data = swung.to_xarray()
    assert data.position.dims == ("time", "body", "axis")
    assert data.orientation.dims == ("time", "body", "quaternion")
    assert data.impact_impulse.dims == ("impact", "contact_axis")
    assert data.impact_inverse_mass.dims == ("impact", "contact_axis", "contact_axis_2")
    assert data.position.sel(body="rod1", axis="z").dims == ("time",)
    np.testing.assert_array_equal(data.position.sel(body="rod1", axis="z"), swung.position[:, 1, 2])
    np.testing.assert_array_equal(data.joint_torque, swung.joint_reactions[..., 3:])
    assert list(data.contact.values) == ["stop"]
    assert list(data.coordinate.values) == ["hinge0", "hinge1"]
    assert list(data.coordinate_units.values) == ["rad", "rad"]
    angle = swung.joint_coordinates("hinge1")[0][:, 0]
    np.testing.assert_array_equal(data.joint_coordinate.sel(coordinate="hinge1"), angle)
    units = {name: one.attrs.get("units") for name, one in data.variables.items()}
    assert units["velocity"] == "m s-1"
    assert units["impact_impulse"] == "N s"
    assert units["ledger_residual"] == "J"
    assert all("long_name" in one.attrs for one in data.variables.values())
    numbers = {name for name, one in data.variables.items() if one.dtype.kind in "fi"}
    without = {name for name in numbers if units[name] is None}
    own = {"joint_coordinate", "joint_rate", "applied_value"}  # in coordinate_units, applied_units
    assert without == own | {"position_error", "velocity_error"}  # in constraint_unit


def test_attributes(thrown):
    data = thrown.to_xarray()
    assert data.attrs["Conventions"] == "CF-1.11"
    assert data.attrs["carom_version"] == carom.__version__
    assert "10.1007/978-3-030-81166-2_44" in data.attrs["citation"]
    assert data.attrs["status"] == "SUCCESS"
    assert json.loads(data.attrs["settings"])["step"] == 5e-3
    assert json.loads(data.attrs["options"]) == carom.Options().as_dict()
    assert json.loads(data.scene.item())["gravity"] == [0.0, 0.0, -9.81]


def test_h5py_alone(thrown, path):
    done = subprocess.run(
        [sys.executable, "-c", READER, str(path)], capture_output=True, text=True, check=True
    )
    lines = done.stdout.splitlines()
    assert lines[0] == "['/time', '/body', '/axis'] m"
    assert lines[1] == f"{thrown.scene.bodies[0].name} newton {len(thrown.impacts)}"
    assert float(lines[2].split()[0]) == thrown.position[-1, 0, 2]
    assert lines[2].split()[1:] == [carom.__version__, "CF-1.11"]


def test_many_contacts_have_rows_only(tmp_path):
    # pairs by default are many: no place for each of them at each time
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    for k in range(3):
        scene.add_body(carom.Sphere(0.1), mass=1.0, position=(k, 0, 0.5), name=f"ball{k}")
    scene.set_contact_default(restitution=0.5)
    data = carom.simulate(scene, 0.01, step=0.01).to_xarray()
    assert "contact_force" not in data
    names = [
        "ball0-floor",
        "ball1-floor",
        "ball2-floor",
        "ball0-ball1",
        "ball0-ball2",
        "ball1-ball2",
    ]
    assert list(data.contact.values) == names


def test_nothing_twice(path):
    # records beside the labelled arrays: only what these do not hold
    _, index = parts_of(path)
    kept = {name.removeprefix("records/") for name in index["arrays"] if "/" in name}
    assert not kept & {"state_x", "state_v", "state_Q", "series_t", "impact_W", "event_time"}
    assert {"snapshot_v0", "event_kind", "impact_phases"} <= kept


def test_pandas(slid, swung):
    frames = slid.to_pandas()
    assert frames.bodies.index.name == "time"
    np.testing.assert_array_equal(frames.bodies.index, slid.t)
    np.testing.assert_array_equal(frames.bodies["block"].z, slid.position[:, 0, 2])
    np.testing.assert_array_equal(frames.bodies["block"].qw, slid.orientation[:, 0, 0])
    np.testing.assert_array_equal(frames.bodies["block"].wy, slid.angular_velocity[:, 0, 1])
    np.testing.assert_array_equal(frames.energy.residual, slid.ledger.residual)
    assert set(frames.impacts.contact) == {"block-ground"}
    np.testing.assert_array_equal(frames.impacts.impulse_t1, slid.impacts.impulse[:, 1])
    np.testing.assert_array_equal(
        frames.impacts.inverse_mass_n_t2, slid.impacts.inverse_mass[:, 0, 2]
    )
    assert list(frames.events.kind) == list(slid.events.kind)
    assert set(frames.contacts["mode"]) <= {"slipping", "sticking"}
    rest = frames.forces[frames.forces.time == slid.t[-1]]
    # it rests: the sum of the normal forces is its weight, to the tolerance of the solve (1e-9 or so)
    assert rest.force_n.sum() == pytest.approx(0.5 * 9.81, rel=1e-6)
    assert set(rest.body) == {"block"}
    assert set(rest.other) == {""}
    assert list(swung.to_pandas().bodies.columns.unique("body")) == ["rod0", "rod1"]
    assert frames.joints.empty
    assert frames.applied_forces.empty


def test_joints_and_forces_in_tables(swung, tmp_path):
    frames = swung.to_pandas(degrees=True)
    angle = np.degrees(swung["hinge1"].coordinate)
    np.testing.assert_allclose(frames.joints["hinge1"].coordinate, angle, rtol=1e-15)
    np.testing.assert_array_equal(frames.joints["hinge0"].fz, swung["hinge0"].force[:, 2])
    force = swung.scene.forces[0]
    np.testing.assert_array_equal(frames.applied_forces[force.name].value, swung[force].torque)
    np.testing.assert_array_equal(frames.applied_forces[force.name].power, swung[force].power)
    impulses = swung["hinge1"].impulses
    assert len(impulses) > 0
    mine = frames.joint_impulses[frames.joint_impulses.joint == "hinge1"]
    np.testing.assert_array_equal(mine.impulse_x, impulses.impulse[:, 0])
    data = swung.to_xarray(degrees=True)
    assert set(data.coordinate_units.values) == {"deg"}
    np.testing.assert_allclose(data.joint_coordinate.sel(coordinate="hinge1"), angle, rtol=1e-15)
    np.testing.assert_array_equal(data.applied_power[:, 0], swung[force].power)
    swung.save(tmp_path / "run.csv")
    for name in ("joints", "applied_forces", "joint_impulses"):
        assert (tmp_path / f"run.{name}.csv").exists()


def test_constraints_have_rows(tmp_path):
    # two wheels on the ground, geared 1 : -2, the first one driven at 3 rad/s
    scene = carom.Scene(gravity=(0, 0, 0))
    hinges = []
    for k, rate in enumerate((3.0, -6.0)):
        wheel = scene.add_body(
            carom.Cylinder(0.1, 0.02), mass=1.0, position=(k, 0, 0), angular_velocity=(0, 0, rate)
        )
        hinge = carom.joints.Revolute((k, 0, 0), (0, 0, 1))
        hinges.append(scene.add_joint(hinge, carom.GROUND, wheel))
    scene.add_constraint(carom.constraints.Gear(*hinges, -2.0), name="gear")
    scene.add_constraint(carom.constraints.Driver(hinges[0], rate=3.0), name="motor")
    run = carom.simulate(scene, 0.1, step=0.01)
    run.save(tmp_path / "run.nc")
    assert differences(carom.Solution.load(tmp_path / "run.nc"), run) == []
    assert derived_differences(carom.Solution.load(tmp_path / "run.nc"), run) == []
    data = run.to_xarray()
    assert list(data.row.values) == ["gear", "motor"]
    np.testing.assert_array_equal(data.constraint_force, run.constraint_forces)
    # q = rate t, to round-off
    np.testing.assert_allclose(data.joint_coordinate[:, 1], -6.0 * data.time, rtol=0, atol=1e-14)
    assert float(data.velocity_error.max()) < 1e-13
