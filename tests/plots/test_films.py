"""Pictures and films: the body is where it should be, and files have what they should."""

import subprocess

import numpy as np
import pytest
from PIL import Image

import carom
from carom.geometry.frames import pair_axes
from carom.visual.films import still
from carom.visual.films.camera import axes_of, fitted
from carom.visual.films.film import frame_times
from carom.visual.films.models import Model
from carom.visual.films.raster import Buffer, paint, shade
from carom.visual.films.stage import Stage

ffmpeg = pytest.importorskip("imageio_ffmpeg")
SMALL = (160, 96)


def coloured(picture):
    """Return where a picture has the blue of the first body."""
    rgb = picture.astype(int)
    return rgb[..., 2] - rgb[..., 0] > 60


def middle(picture):
    """Return the pixel (x, y) in the middle of the blue."""
    rows, columns = np.nonzero(coloured(picture))
    return 0.5 * np.array([columns.min() + columns.max(), rows.min() + rows.max()]) + 0.5


def pictures(path):
    """Return the pictures of an MP4 (n, height, width, 3) and its pictures a second."""
    command = [
        ffmpeg.get_ffmpeg_exe(),
        "-v",
        "error",
        "-i",
        path,
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-",
    ]
    done = subprocess.run(command, capture_output=True, check=True)
    width, height = SMALL
    frames = np.frombuffer(done.stdout, np.uint8).reshape(-1, height, width, 3)
    return frames, len(frames) / ffmpeg.count_frames_and_secs(path)[1]


def empty(height, width):
    """Return a buffer in which nothing has been painted."""
    image, depth = np.zeros((height, width, 3), np.uint8), np.zeros((height, width), np.float32)
    return Buffer(image, depth, np.zeros((height, width), np.uint8))


@pytest.fixture(scope="module")
def ball():
    """A ball of 0.1 m on its way sideways and down, to rest on nothing."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.add_body(
        carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.8), velocity=(1.0, 0, 0), name="ball"
    )
    with pytest.warns(carom.MistakeWarning, match="Nothing can touch 'ball'"):
        return carom.simulate(scene, 0.3, step=0.05)


def test_a_point_is_seen_where_the_camera_says():
    axes = axes_of("front", carom.Scene())
    np.testing.assert_allclose(np.array(axes) @ np.transpose(axes), np.eye(3), atol=1e-15)
    assert axes.right == pytest.approx([1, 0, 0], abs=1e-15)  # x to the right, seen from -y
    assert axes.towards[1] < -0.9
    camera = fitted(axes, np.zeros((1, 3)), np.array([1.0]), (200, 100))
    assert camera.project(np.zeros(3))[:2] == pytest.approx([100, 50])
    x, y, near = camera.project(0.5 * axes.up + 0.25 * axes.right)
    assert near == pytest.approx(1.0 / camera.distance)
    assert (x - 100) * 2 == pytest.approx(50 - y)


@pytest.mark.parametrize("view", ["oblique", "front", "side", "top", (30.0, -20.0)])
def test_the_camera_sees_all_and_not_much_more(view):
    rng = np.random.default_rng(3)
    places, radii = rng.normal(size=(50, 3)), rng.uniform(0.01, 0.3, 50)
    camera = fitted(axes_of(view, carom.Scene(gravity=(0, -9.81, 0))), places, radii, (320, 180))
    reach = [places + radii[:, None] * sign * e for e in camera.axes[:2] for sign in (-1, 1)]
    seen = camera.project(np.concatenate(reach))
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    assert np.all(low >= 0) and np.all(high <= (320, 180))  # noqa: PT018
    assert max((high - low) / (320, 180)) > 0.6


def test_the_ball_is_painted_at_its_place_and_as_large_as_it_is(ball):
    stage = Stage(ball, SMALL, "front")
    for t in (0.0, 0.3):
        picture = stage.draw(t, clock=False)
        assert picture.shape == (96, 160, 3)
        assert picture.dtype == np.uint8
        x, y, near = stage.camera.project(ball.evaluate(t)[0][0])
        rows, columns = np.nonzero(coloured(picture))
        radius = 0.1 * near * stage.camera.focal / 2
        assert columns.max() - columns.min() + 1 == pytest.approx(2 * radius, abs=2.0)
        assert 0.5 * (columns.max() + columns.min()) + 0.5 == pytest.approx(x / 2, abs=1.0)
        assert 0.5 * (rows.max() + rows.min()) + 0.5 == pytest.approx(y / 2, abs=1.0)


@pytest.mark.plain
@pytest.mark.parametrize("order", [[0, 1], [1, 0]])
def test_what_is_near_hides_what_is_far(order):
    # A red triangle before a blue one that is larger; in whatever order they come.
    near = [(2.0, 2.0, 1.0), (2.0, 8.0, 1.0), (8.0, 8.0, 1.0)]
    far = [(0.0, 0.0, 0.5), (0.0, 10.0, 0.5), (10.0, 10.0, 0.5)]
    corners, colours = np.array([near, far])[order], np.array([(1.0, 0, 0), (0, 0, 1.0)])[order]
    buffer = empty(10, 10)
    towards = np.array([0, 0, 1.0])
    model = Model(corners, np.tile(towards, (2, 3, 1)), colours, np.zeros((2, 3), np.int8))
    paint(model, towards, towards, 0.5, buffer)
    assert np.argmax(buffer.image[6, 4]) == 0
    assert np.argmax(buffer.image[8, 1]) == 2
    assert not buffer.image[1, 8].any()
    assert buffer.depth[6, 4] == 1.0
    assert buffer.depth[8, 1] == 0.5
    buffer = empty(10, 10)  # turned away: nothing is painted
    paint(model._replace(corners=corners[:, ::-1].copy()), towards, towards, 0.5, buffer)
    assert not buffer.image.any()


@pytest.mark.plain
def test_a_shadow_is_cast_once_and_on_its_own_plane_only():
    # Two triangles that overlap on plane 1; the last column of pixels shows plane 2.
    buffer = empty(8, 8)
    buffer.image[:], buffer.plane[:], buffer.plane[:, 7] = 200, 1, 2
    half = [(0.0, 0.0, 1.0), (0.0, 8.0, 1.0), (8.0, 8.0, 1.0)]
    shade(np.array([half, half[::-1]]), 0.5, 1, buffer)
    assert buffer.image[5, 2].tolist() == [100, 100, 100]
    assert buffer.image[2, 5].tolist() == [200, 200, 200]
    assert buffer.image[7, 7].tolist() == [200, 200, 200]
    assert buffer.plane[5, 2] == 0


def test_the_ground_has_a_shadow_below_the_ball(ball):
    picture = still(ball, 0.3, size=SMALL, view=(-90.0, 30.0), clock=False).astype(int)
    grey = (np.ptp(picture, axis=2) < 8) & (picture[..., 0] < 205) & (picture[..., 0] > 150)
    assert 10 < grey.sum() < 0.1 * grey.size


def test_mp4_has_its_pictures_and_the_body_moves(ball, tmp_path):
    done = []
    path = carom.film(ball, tmp_path / "ball.mp4", fps=20, size=SMALL, view="front",
                      progress=lambda k, n: done.append((k, n)))  # fmt: skip
    frames, rate = pictures(path)
    assert len(frames) == 7  # 0, 0.05, ..., 0.3 s
    assert done == [(k + 1, 7) for k in range(7)]
    assert rate == pytest.approx(20, rel=0.01)
    places = np.array([middle(frame) for frame in frames])
    assert np.all(np.diff(places, axis=0) > 0)  # to the right, and down
    fall = np.diff(places[:, 1])
    assert fall[-1] > 3 * fall[0]  # faster and faster: 11 to 1


def test_gif_in_slow_motion(ball, tmp_path):
    path = carom.film(
        ball, tmp_path / "ball.gif", fps=30, speed=0.5, size=SMALL, start=0.1, end=0.3
    )
    with Image.open(path) as gif:
        assert gif.n_frames == 13  # 0.2 s at half speed: 0.4 s of film
        assert gif.size == SMALL
        total = 0
        for k in range(13):
            gif.seek(k)
            total += gif.info["duration"]
    assert total == pytest.approx(13 / 30 * 1e3, abs=10.0)


def test_a_body_that_is_followed_stays_in_the_middle(ball):
    stage = Stage(ball, SMALL, "front", "ball")
    for t in (0.0, 0.15, 0.3):
        assert middle(stage.draw(t, clock=False)) == pytest.approx([80, 48], abs=1.0)


def test_an_impulse_is_an_arrow_for_a_while(thrown):
    stage = Stage(thrown, (320, 180))
    at = thrown.impacts.time[0]

    def red(t):
        picture = stage.draw(t, clock=False).astype(int)
        return np.count_nonzero(picture[..., 0] - picture[..., 2] > 150)

    assert red(at - 1e-6) == 0
    assert red(at) > 20
    assert stage.marks.arrow[0] @ (0, 0, 1) > 0  # the ground pushes up
    stage.marks.linger = 1e-4
    assert red(at + 2e-4) == 0


def test_impulses_have_the_axes_of_the_contact(thrown):
    # The change of momentum of the one body is the impulse, in world axes.
    stage = Stage(thrown, SMALL)
    for k, at in enumerate(thrown.impacts.time):
        before, after = (thrown.evaluate(at, side)[2][0] for side in ("left", "right"))
        push = thrown.scene.bodies[0].mass * (after - before)
        arrow = stage.marks.arrow[k]
        assert arrow / np.linalg.norm(arrow) == pytest.approx(push / np.linalg.norm(push), abs=1e-9)
    n = np.array([0.9, 0.3, np.sqrt(1 - 0.9)])
    np.testing.assert_allclose(pair_axes(n) @ pair_axes(n).T, np.eye(3), atol=1e-15)


@pytest.mark.parametrize("run", ["thrown", "slid", "swung"])
def test_every_kind_of_scene_is_drawn(run, request):
    picture = still(request.getfixturevalue(run), size=SMALL, clock=False)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 10


def test_a_film_from_a_file(thrown, tmp_path):
    thrown.save(tmp_path / "run.nc")
    again = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(still(again, 0.2, size=SMALL), still(thrown, 0.2, size=SMALL))


def test_times_of_pictures():
    assert frame_times(0.0, 1.0, 30.0, 1.0) == pytest.approx(np.arange(31) / 30)
    assert frame_times(0.2, 0.3, 10.0, 0.5) == pytest.approx([0.2, 0.25, 0.3])
    assert len(frame_times(0.0, 0.1, 7.0, 1.0)) == 1


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("film.avi", {}, r"path must end in \.gif or \.mp4"),
        ("none/film.gif", {}, "folder that exists"),
        ("film.gif", {"fps": 60}, "fps must be .* at most 50"),
        ("film.mp4", {"speed": 0}, "speed"),
        ("film.mp4", {"size": (161, 96)}, "even"),
        ("film.mp4", {"size": 160}, "width, height"),
        ("film.mp4", {"view": "below"}, "view must be one of"),
        ("film.mp4", {"view": (0, 91)}, "elevation"),
        ("film.mp4", {"follow": "dog"}, "follow must be among 'ball'"),
        ("film.mp4", {"start": 1.0}, "start"),
        ("film.mp4", {"zoom": -1}, "zoom"),
    ],
)
def test_bad_input_is_named(ball, tmp_path, name, options, message):
    with pytest.raises(ValueError, match=message):
        carom.film(ball, tmp_path / name, **options)
    assert not list(tmp_path.iterdir())


def test_coordinates_have_no_film(bounced, tmp_path):
    with pytest.raises(ValueError, match="scene of bodies"):
        carom.film(bounced, tmp_path / "film.gif")
