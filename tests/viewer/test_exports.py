"""Files for other programs: the bodies are where the solution has them, at the times that it says."""

import json
import struct
from xml.etree import ElementTree

import numpy as np
import pytest

import carom
from carom.geometry import quaternion
from simulate.scenes import G

Y_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # from z up to y up: (x, z, -y)


@pytest.fixture(scope="module")
def hung():
    """A ball on a spring from the ground, aside of the vertical."""
    scene = carom.Scene()
    ball = scene.add_body(
        carom.Sphere(0.1), mass=1.0, position=(0.3, 0, -1), name="ball", color="red"
    )
    scene.add_half_space((0, 0, -3), (0, 0, 1), color="#009e73", name="ground")
    for x, name in ((-2, "wall"), (2, "door")):
        scene.add_static(carom.Box(0.1, 1, 1), position=(x, 0, -2.5), name=name)
    scene.set_contact_default(restitution=0.5)
    spring = carom.forces.Spring(100.0, (0, 0, 0), (0.3, 0, -0.9))
    scene.add_force(spring, carom.GROUND, ball)
    return carom.simulate(scene, 0.5, step=0.01)


@pytest.fixture(scope="module")
def glb(thrown, tmp_path_factory):
    """The die as glTF."""
    pytest.importorskip("pygltflib")
    return thrown.export(tmp_path_factory.mktemp("export") / "die.glb")


class Gltf:
    """A ``.glb`` read by its specification alone."""

    def __init__(self, path):
        data = path.read_bytes()
        assert struct.unpack_from("<III", data) == (0x46546C67, 2, len(data))
        length, kind = struct.unpack_from("<II", data, 12)
        assert kind == 0x4E4F534A
        self.head = json.loads(data[20 : 20 + length])
        self.block = data[28 + length :]
        self.nodes = {node.get("name"): k for k, node in enumerate(self.head["nodes"])}

    def numbers(self, k):
        """The numbers of an accessor."""
        accessor = self.head["accessors"][k]
        view = self.head["bufferViews"][accessor["bufferView"]]
        parts = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        count = parts * accessor["count"]
        return np.frombuffer(self.block, kind, count, view["byteOffset"]).reshape(-1, parts)

    def track(self, name, path):
        """Times and values of one animated property of a node."""
        (animation,) = self.head["animations"]
        target = {"node": self.nodes[name], "path": path}
        (channel,) = [c for c in animation["channels"] if c["target"] == target]
        sampler = animation["samplers"][channel["sampler"]]
        return self.numbers(sampler["input"])[:, 0], self.numbers(sampler["output"])


def test_the_animation_is_the_motion(thrown, glb):
    file = Gltf(glb)
    (name,) = [body.name for body in thrown.scene.bodies]
    times, places = file.track(name, "translation")
    _, turns = file.track(name, "rotation")
    assert times[0] == 0.0
    assert abs(times[-1] - thrown.t[-1]) < 1e-7
    assert np.isin(thrown.impacts.time.astype("f4"), times).all()
    x, Q, _, _ = thrown.evaluate(np.clip(times.astype(float), 0.0, thrown.t[-1]))
    # single precision of times at 5 m/s and 20 rad/s
    assert np.abs(places - x[:, 0]).max() < 1e-6
    assert np.sum(turns[1:] * turns[:-1], axis=1).min() > 0.0
    assert np.abs(np.abs(np.sum(turns[:, [3, 0, 1, 2]] * Q[:, 0], axis=1)) - 1.0).max() < 1e-6
    root = file.head["nodes"][0]
    turn = np.array(root["rotation"])[[3, 0, 1, 2]]
    np.testing.assert_allclose(quaternion.matrix(turn), Y_UP, atol=1e-12)


def test_another_library_sees_the_bodies_where_they_start(thrown, glb):
    trimesh = pytest.importorskip("trimesh")
    (body,) = thrown.scene.bodies
    seen = trimesh.load(glb)
    place, _ = seen.graph[body.name]
    np.testing.assert_allclose(place[:3, 3], Y_UP @ body.position, atol=1e-7)
    turned = Y_UP @ quaternion.matrix(thrown.orientation[0, 0])
    np.testing.assert_allclose(place[:3, :3], turned, atol=1e-6)
    (shape,) = [g for name, g in seen.geometry.items() if name.startswith(body.name)]
    assert abs(shape.volume / body.shape.volume - 1.0) < 1e-6
    colour = np.array(shape.visual.material.baseColorFactor[:3]) / 255.0
    screen = np.array([*bytes.fromhex("56B4E9")]) / 255.0  # the first of the palette
    np.testing.assert_allclose(colour, ((screen + 0.055) / 1.055) ** 2.4, atol=1 / 255)


def test_blender_sees_the_motion(thrown, glb):
    bpy = pytest.importorskip("bpy")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(glb))
    film, name = bpy.context.scene, thrown.scene.bodies[0].name
    for t in np.linspace(0.0, thrown.t[-1], 6):
        frame = t * film.render.fps
        film.frame_set(int(frame), subframe=frame % 1.0)
        found = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())
        x, Q, _, _ = thrown.evaluate(t)
        np.testing.assert_allclose(found.matrix_world.translation, x[0], atol=2e-5)
        # Blender turns the axes of meshes too, from y up to z up
        turn = np.array(found.matrix_world)[:3, :3] @ Y_UP.T
        np.testing.assert_allclose(turn, quaternion.matrix(Q[0]), atol=2e-5)


def test_a_spring_reaches_from_end_to_end(hung, tmp_path):
    pytest.importorskip("pygltflib")
    file = Gltf(hung.export(tmp_path / "hung.glb", fps=100))
    times, sizes = file.track("spring1", "scale")
    np.testing.assert_allclose(times, hung.t, atol=1e-7)
    ends = hung.position[:, 0] + quaternion.rotate(hung.orientation[:, 0], (0, 0, 0.1))
    np.testing.assert_allclose(sizes[:, 2], np.linalg.norm(ends, axis=1), rtol=1e-6)
    _, middle = file.track("spring1", "translation")
    np.testing.assert_allclose(middle, 0.5 * ends, atol=1e-6)
    meshes, materials = file.head["meshes"], file.head["materials"]
    shades = {one["name"]: materials[one["primitives"][0]["material"]]["name"] for one in meshes}
    assert (shades["ball"], shades["ground"]) == ("#ff0000", "#009e73")
    assert {"wall", "door"} <= set(file.nodes)


def test_a_spring_that_is_cut_has_no_size(tmp_path):
    pytest.importorskip("pygltflib")
    scene = carom.Scene()
    box = scene.add_body(carom.Box(0.2, 0.2, 0.2), mass=1.0, position=(0, 0, -0.5))
    scene.add_force(carom.forces.Spring(40.0, (0, 0, 0.2), (0, 0, -0.4)), box, name="cut")
    scene.switch("cut", at=0.3)
    times, sizes = Gltf(carom.simulate(scene, 0.5).export(tmp_path / "cut.glb", fps=100)).track(
        "spring1", "scale"
    )
    assert np.all(sizes[times < 0.2999, 2] > 0.5)
    assert np.all(sizes[times > 0.3001] == 0.0)


def test_frames_of_a_part_of_the_run_at_a_slower_speed(thrown, tmp_path):
    pytest.importorskip("pygltflib")
    path = thrown.export(tmp_path / "slow.glb", fps=20, speed=0.1, start=0.05, end=0.1)
    times, places = Gltf(path).track("body1", "translation")
    np.testing.assert_allclose(times, np.arange(11) / 20, atol=1e-7)
    np.testing.assert_allclose(places[-1], thrown.evaluate(0.1)[0][0], atol=1e-7)


@pytest.fixture(scope="module")
def pvd(thrown, tmp_path_factory):
    """The die for ParaView: the path, and (time, part, path) of each file in its list."""
    pytest.importorskip("meshio")
    path = thrown.export(tmp_path_factory.mktemp("export") / "die.pvd")
    sets = ElementTree.parse(path).getroot().iter("DataSet")
    return [
        (float(s.get("timestep")), int(s.get("part")), path.parent / s.get("file")) for s in sets
    ]


def test_velocities_are_those_of_the_points(thrown, pvd):
    meshio = pytest.importorskip("meshio")
    bodies = [(t, meshio.read(path)) for t, part, path in pvd if part == 0]
    np.testing.assert_array_equal([t for t, _ in bodies], thrown.t)
    assert thrown.impacts.time[0] > thrown.t[20]
    (t0, before), (t1, now), (t2, after) = bodies[10:13]
    rate = (after.points - before.points) / (t2 - t0)
    # a central difference: h^2/6 times the third derivative, here w^3 r, and single precision
    h, speed = t1 - t0, np.linalg.norm(thrown.angular_velocity[11, 0])
    size = thrown.scene.bodies[0].shape.size
    assert np.abs(rate - now.point_data["velocity"]).max() < speed**3 * size * h**2 / 6 + 1e-4
    assert set(now.cell_data["body"][0]) == {0}
    np.testing.assert_allclose(
        now.cell_data["velocity_of_mass_centre"][0][0], thrown.velocity[11, 0], rtol=1e-6
    )


def test_impulses_balance_momentum(thrown, pvd):
    meshio = pytest.importorskip("meshio")
    assert not len(thrown.forces.point)
    some = [path for _, part, path in pvd if part == 1 and b'Points="0"' not in path.read_bytes()]
    points = [meshio.read(path).point_data["impulse"] for path in some]  # it reads no empty file
    mass = thrown.scene.bodies[0].mass
    change = mass * (thrown.velocity[-1, 0] - thrown.velocity[0, 0])
    gravity = mass * np.array([0, 0, -G]) * thrown.t[-1]
    assert sum(map(len, points)) == len(thrown.impacts) > 0
    np.testing.assert_allclose(sum(one.sum(axis=0) for one in points), change - gravity, rtol=1e-9)


def test_forces_hold_what_slides(slid, tmp_path):
    meshio = pytest.importorskip("meshio")
    slid.export(tmp_path / "slid.pvd", fps=20)
    files = sorted((tmp_path / "slid").glob("contacts*.vtu"))
    assert len(files) == 7
    forces = meshio.read(files[3]).point_data["force"]
    weight = slid.scene.bodies[0].mass * G
    assert abs(forces[:, 2].sum() - weight) < 1e-9 * weight


def test_vtk_opens_every_kind_of_file(pvd):
    vtk = pytest.importorskip("vtk")
    for path in {p for _, part, p in pvd if part == 2} | {p for t, _, p in pvd if t == 0.0}:
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        assert reader.GetErrorCode() == 0
        count = reader.GetOutput().GetNumberOfCells()
        assert count == 0 if path.name.startswith("contacts") else count > 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"path": "run.obj"}, r"path must end in \.glb, \.pvd, got 'run\.obj'; a page"),
        ({"path": "no/run.glb"}, "path must be the path of a file in a folder that exists"),
        ({"fps": 0}, "fps must be finite and above 0"),
        ({"fps": 1e9}, "speed and fps must give at most 100000 frames"),
        ({"start": 1.0}, "start must be"),
    ],
)
def test_wrong_arguments_are_refused_by_name(thrown, arguments, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=words):
        thrown.export(**{"path": "run.glb", **arguments})
