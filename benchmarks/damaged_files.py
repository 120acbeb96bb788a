"""What becomes of damaged and made-up files: refused, the same to the last bit, or what should not be.

python benchmarks/damaged_files.py [COUNT] [SEED]

Of runs, scenes as JSON and models COUNT each (default 1000). Each is loaded, and looked at in every way, in a
child process with a limit of time and memory; one that hangs, dies or raises what is no ValueError or OSError
is printed with its seed. Made-up files are damaged inside, with a digest that is right.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import random
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pandas  # noqa: F401  (so that each child has them)
import xarray  # noqa: F401

import carom
from carom.io.files import sealed
from carom.io.files.scene_parts import scene_from_text, scene_to_text

SECONDS, WAIT = 5, 300.0  # of processor time, and on the clock, for one file
MEMORY, PART = 4 << 30, 20
MODEL = """<mujoco><worldbody><geom type="plane" size="1 1 1"/><replicate count="3" offset="1 0 0">
<body pos="0 0 1" name="a"><freejoint/><geom type="box" size=".1 .1 .1" mass="1"/></body></replicate>
<body pos="5 0 1"><joint type="hinge" axis="0 1 0" range="-1 1"/>
<geom size=".1" fromto="0 0 0 1 0 0" type="capsule"/></body></worldbody></mujoco>"""
WORDS = (
    b"nan",
    b"1e308",
    b"-1",
    b"null",
    b"[]",
    b"{}",
    b'""',
    b"999999999999",
    b"NaN",
    b"true",
    b"0",
    b"\xff",
)


def runs(folder: Path) -> list[bytes]:
    """Files of a die that strikes, slides and is stopped, and of a pendulum with a joint."""
    scene = carom.Scene()
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    die = scene.add_body(
        carom.Box(0.2, 0.1, 0.05), mass=0.5, position=(0, 0, 0.1), velocity=(1, 0.2, 0), name="die"
    )
    scene.add_contact(die, ground, restitution=0.3, friction=0.3)
    swing = carom.Scene()
    rod = swing.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0))
    swing.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)

    def stop(done, total):
        if done > total // 2:
            raise KeyboardInterrupt

    made = []
    for one, progress in ((scene, None), (scene, stop), (swing, None)):
        path = folder / "run.nc"
        carom.simulate(one, 0.4, step=5e-3, save=path, progress=progress, throw=False)
        made.append(path.read_bytes())
    return made


def damaged(data: bytes, rng: random.Random) -> bytes:
    """Damage as disks and networks do it."""
    broken, size = bytearray(data), len(data)
    a, b = sorted((rng.randrange(size), rng.randrange(size)))
    kind = rng.randrange(6)
    if kind == 0:
        broken = broken[:a]
    elif kind == 1:
        broken[a : a + 512] = bytes(len(broken[a : a + 512]))
    elif kind == 2:
        broken = broken[:a] + broken[b:]
    elif kind == 3:
        broken += bytes(rng.randrange(256) for _ in range(rng.randrange(1, 100)))
    else:
        for _ in range(rng.randrange(1, 30)):
            broken[rng.randrange(size)] = rng.randrange(256)
    return bytes(broken)


def made_up(data: bytes, rng: random.Random) -> bytes:
    """Other numbers, words or bytes inside, sealed again."""
    tail = sealed.TAIL.fullmatch(data[-sealed.LENGTH :])
    assert tail is not None
    end = len(data) - sealed.LENGTH
    start = end - int(tail[2])
    body, index = bytearray(data[:start]), bytearray(data[start:end])
    for _ in range(rng.randrange(1, 6)):
        part = rng.choice((body, index, index))
        at = rng.randrange(len(part))
        if rng.random() < 0.4:
            part[at] = rng.randrange(256)
        elif part is body:
            part[at : at + 8] = rng.choice((b"\xff" * 8, bytes(8), np.float64(1e308).tobytes()))[
                : len(part) - at
            ]
        else:
            other(part, at, rng)
    text = bytes(index)
    head = (sealed.BEFORE % (sealed.FORMAT, len(text))).encode()
    digest = sealed.hashlib.sha256(bytes(body) + text + head).hexdigest()
    return bytes(body) + text + head + f"{digest}\n".encode()


def other(text: bytearray, at: int, rng: random.Random) -> None:
    """Put another word in the place of the one at a place of a text."""
    ends = b' ,:[]{}<>="'
    end = next((k for k in range(at, len(text)) if text[k] in ends), len(text))
    while at > 0 and text[at - 1] not in ends:
        at -= 1
    text[at:end] = rng.choice(WORDS)


def words(data: bytes, rng: random.Random) -> bytes:
    """A text with some other words and bytes, perhaps cut short."""
    text = bytearray(data)
    for _ in range(rng.randrange(1, 4)):
        other(text, rng.randrange(len(text)), rng)
    if rng.random() < 0.3:
        text[rng.randrange(len(text))] = rng.randrange(256)
    return bytes(text[: rng.choice([len(text)] * 9 + [rng.randrange(len(text))])])


def look_at_run(path: Path, known: list[bytes]) -> str:
    """Load a run, and ask it for all that it holds; say whether it is one of the whole ones."""
    found = carom.Solution.load(path)
    _ = repr(found), str(found.scene), len(found.impacts), found.message, found.success
    _ = found.contact_mode, found.contact_force, found.forces, found.ledger.residual
    found.evaluate(
        np.linspace(found.t[0], found.t[-1], 5) if np.all(np.diff(found.t) > 0) else found.t[0]
    )
    with contextlib.suppress(ValueError, OSError):
        _ = found.to_pandas(), found.to_xarray()
    return "the same" if path.read_bytes() in known else "read"


def look_at_scene(path: Path, known: list[bytes]) -> str:
    """Make a scene of JSON, and look at it."""
    scene, _ = scene_from_text(path.read_text(encoding="utf-8"))
    _ = repr(scene), str(scene), scene_to_text(scene), scene.validate()
    return "read"


def look_at_model(path: Path, known: list[bytes]) -> str:
    """Make a scene of a model."""
    carom.load_model(path, contacts=False)
    return "read"


def part_of(kind: str, seeds: list[int], wholes: list[bytes], line) -> None:
    """Do some seeds, and tell what came of each before the next begins."""
    warnings.simplefilter("ignore")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    change, look, end = KINDS[kind]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"file{end}"
        for seed in seeds:
            limit = int(time.process_time()) + SECONDS, resource.getrlimit(resource.RLIMIT_CPU)[1]
            resource.setrlimit(resource.RLIMIT_CPU, limit)
            rng = random.Random(f"{kind} {seed}")
            path.write_bytes(change(rng.choice(wholes), rng))
            try:
                told = look(path, wholes)
            except (ValueError, OSError):
                told = "refused"
            except BaseException as error:
                told = f"{type(error).__name__}: {error}"
            line.send((seed, told))


KINDS = {
    "damaged runs": (damaged, look_at_run, ".nc"),
    "made-up runs": (made_up, look_at_run, ".nc"),
    "scenes": (words, look_at_scene, ".json"),
    "models": (words, look_at_model, ".xml"),
}


def campaign(kind: str, count: int, first: int, wholes: list[bytes]) -> Counter:
    """Try `count` files of a kind; print those that hang, die or raise what they should not."""
    counts, left = Counter(), list(range(first, first + count))
    context = multiprocessing.get_context("fork")
    while left:
        here, there = context.Pipe(duplex=False)
        seeds = left[:PART]
        child = context.Process(target=part_of, args=(kind, seeds, wholes, there))
        child.start()
        there.close()
        for seed in seeds:
            told = None if here.poll(WAIT) else "hangs"
            with contextlib.suppress(EOFError):
                told = told or here.recv()[1]
            if told is None:
                child.join()
                told = "hangs" if child.exitcode == -signal.SIGXCPU else "dies"
            left.remove(seed)
            known = told in ("refused", "read", "the same")
            counts[told if known else "wrong"] += 1
            if not known:
                print(f"{kind}, seed {seed}: {told[:200]}", flush=True)
            if told in ("hangs", "dies"):
                break
        child.kill()
        child.join()
    return counts


def main(count: int = 1000, first: int = 0) -> None:
    """Try all kinds, and print a table."""
    with tempfile.TemporaryDirectory() as folder:
        files = runs(Path(folder))
    texts = [sealed.json.dumps(scene_of(data)).encode() for data in files]
    wholes = {"scenes": texts, "models": [MODEL.encode()]}
    for kind in KINDS:
        counts = campaign(kind, count, first, wholes.get(kind, files))
        print(
            f"{kind:15}", ", ".join(f"{n} {what}" for what, n in sorted(counts.items())), flush=True
        )


def scene_of(data: bytes):
    """The scene in a file of a run."""
    tail = sealed.TAIL.fullmatch(data[-sealed.LENGTH :])
    assert tail is not None
    end = len(data) - sealed.LENGTH
    return sealed.json.loads(sealed.json.loads(data[end - int(tail[2]) : end])["scene"])


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
