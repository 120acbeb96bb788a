"""`carom.film`: a motion as a film."""

from __future__ import annotations

import errno
import io
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from carom import arguments, checks
from carom.io.files.disk import put, staged
from carom.visual.films.marks import LINGER
from carom.visual.films.stage import Stage, pillow
from carom.visual.plots.figure import need_bodies

SUFFIXES = (".gif", ".mp4")
MOST_PICTURES = 100_000  # pictures of a film: an hour


@arguments.known
def film(
    solution, path, *, fps: float = 30, speed: float = 1.0, size=(1280, 720), view="oblique", follow=None,
    zoom: float = 1.0, start: float | None = None, end: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Path:  # fmt: skip
    """Write the motion of a solution as a film: MP4 (H.264) or GIF, depending on the suffix of the file.

    Bodies are solid, each in its own colour, and cast shadows on half-spaces, which have a grid. A half-space
    is left out if the camera is behind its surface. Round bodies have patches that show their rotation. Bodies
    without a shape are drawn as what rolls, as rods from the mass centre to the joints, or as the ellipsoid of
    their inertia. An orange arrow shows the impulse of an impact for 0.15 s of the film; its length is
    proportional to the square root of the impulse. Black dots are persistent contacts. Between saved times the
    motion is that of `Solution.evaluate`.

    Parameters
    ----------
    solution : Solution
        The run.
    path : str or path
        Path of the film with the suffix ``.mp4`` or ``.gif``, in a folder that exists.
    fps : float
        Frames per second, above 0, at most 1000. Default 30. In a GIF the time of a frame is a whole number of
        hundredths of a second, so at most 50.
    speed : float
        Seconds of motion per second of the film; below 1 is slow motion. Default 1. A film has at most 100 000
        frames.
    size : (int, int)
        Width and height in pixels, even numbers. Default (1280, 720).
    view : str or (float, float)
        "oblique" (default), "front", "side", "top", or azimuth and elevation of the camera [degrees]. The
        azimuth is measured about the vertical from world x (front: -90); the vertical is opposite to gravity,
        or z without gravity.
    follow : str or Body, optional
        A body that stays in the centre of the picture. Default None: the camera does not move and sees the
        whole motion.
    zoom : float
        Magnification, 0.001 to 1000; above 1 shows bodies larger. Default 1.
    start, end : float, optional
        Start and end of the shown part of the run [s]. Default: the whole run.
    progress : callable, optional
        Function that is called as ``progress(done, count)`` after each frame.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ImportError
        If a package is missing: pillow, and for MP4 imageio and imageio-ffmpeg.
    ValueError
        If an argument is invalid.
    """
    need_bodies(solution, "film")
    path = checks.path("path", path)
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(f"path must end in {' or '.join(SUFFIXES)}, got {str(path)!r}")
    if not path.parent.is_dir():
        raise ValueError(f"path must be in a folder that exists, got {str(path)!r}")
    gif = path.suffix.lower() == ".gif"
    fps = checks.number("fps", fps, above=0.0, most=50.0 if gif else 1000.0)
    checks.scale("fps", fps)
    speed = checks.scale("speed", speed)
    checks.function("progress", progress, optional=True)
    begin, stop = span_of(solution, start, end)
    pillow()
    stage = Stage(solution, size, view, follow, (begin, stop), zoom)
    stage.marks.linger = LINGER * speed
    times = frame_times(begin, stop, fps, speed)

    def pictures():
        for k, t in enumerate(times):
            yield stage.draw(t)
            if progress is not None:
                checks.call("progress", progress, k + 1, len(times))

    (_write_gif if gif else _write_mp4)(path, pictures(), fps)
    return path


def span_of(solution, start: float | None, end: float | None) -> tuple[float, float]:
    """Return the shown part of a run [s]; None: its start, its end."""
    begin, stop = float(solution.t[0]), float(solution.t[-1])
    if start is not None:
        begin = checks.number("start", start, least=begin, most=stop, unit="s")
    if end is not None:
        stop = checks.number("end", end, least=begin, most=stop, unit="s")
    return begin, stop


def frame_times(begin: float, end: float, fps: float, speed: float) -> np.ndarray:
    """Return the times of the pictures [s], the first at `begin`."""
    if not (end - begin) * fps <= MOST_PICTURES * speed:
        raise ValueError(
            f"speed and fps must give at most {MOST_PICTURES} frames, got {(end - begin):g} s with "
            f"speed={speed:g} and fps={fps:g}"
        )
    count = math.floor((end - begin) * fps / speed + 1e-9) + 1
    return np.minimum(begin + speed / fps * np.arange(count), end)


def _write_mp4(path: Path, pictures, fps: float) -> None:
    for module in ("imageio_ffmpeg", "imageio.v2"):
        what = "a film in MP4 (one in .gif does not)"
        imageio = checks.need(module, what, "film", "imageio-ffmpeg")
    with staged(path) as folder:
        made = folder / path.name
        with imageio.get_writer(
            made, format="FFMPEG", fps=fps, codec="libx264", pixelformat="yuv420p", macro_block_size=2,  # pyright: ignore
            output_params=["-crf", "18", "-preset", "medium", "-movflags", "+faststart"],
        ) as writer:  # fmt: skip
            for picture in pictures:
                writer.append_data(picture)  # pyright: ignore[reportAttributeAccessIssue]
        if not _is_whole(made):
            raise OSError(errno.EIO, "ffmpeg could not write the film, for example on a full disk")


def _is_whole(path: Path) -> bool:
    """Return whether an MP4 has all its boxes: ffmpeg does not say when its disk was full.

    A box begins with its length (ISO/IEC 14496-12, §4.2): four bytes, or eight after a length of 1.
    """
    at, end, names = 0, path.stat().st_size, []
    with path.open("rb") as file:
        while at < end:
            file.seek(at)
            head = file.read(16)
            length = int.from_bytes(head[:4], "big")
            length = int.from_bytes(head[8:], "big") if length == 1 else length
            names.append(head[4:8])
            if length < 8:
                return False
            at += length
    return at == end and {b"ftyp", b"moov", b"mdat"} <= set(names)


def _write_gif(path: Path, pictures, fps: float) -> None:
    Image, _, _ = pillow()
    # one palette for all: with one each, colours of what stands still would flicker
    frames = [Image.fromarray(picture) for picture in pictures]
    palette = frames[len(frames) // 2].quantize(256, dither=Image.Dither.NONE)
    frames = [one.quantize(palette=palette, dither=Image.Dither.NONE) for one in frames]
    # hundredths of a second are what the format has: shared out so that the whole lasts as long as it should
    ends = np.round(100.0 / fps * np.arange(len(frames) + 1)).astype(int)
    out = io.BytesIO()
    frames[0].save(
        out, "GIF", save_all=True, append_images=frames[1:], duration=(10 * np.diff(ends)).tolist(), loop=0,
        optimize=False,
    )  # fmt: skip
    put(path, [out.getbuffer()])
