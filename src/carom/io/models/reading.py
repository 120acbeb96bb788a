"""From a file, a text or a specification to a compiled MuJoCo model."""

from __future__ import annotations

import os
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np

from carom.io.models.limits import check_model, drop_sizes, parsed
from carom.io.models.report import Report, need_mujoco
from carom.io.models.urdf import colours, drop_visuals, name_visuals, prepared

READ = ("body_", "jnt_", "dof_", "geom_", "eq_", "pair_", "qpos", "mesh_vert", "key_q")  # arrays
DERIVED = ("body_invweight0", "dof_invweight0", "jnt_actfrcrange", "jnt_range")


def compiled_model(source, free_root: bool, package_dirs, report: Report) -> Any:
    """Return the ``mujoco.MjModel`` of a path, an XML text, an ``MjSpec`` or an ``MjModel``.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    TypeError
        If `source` is something else.
    ValueError
        With MuJoCo's message in one line, if it cannot read or compile the model.
    """
    mujoco, said = need_mujoco(), []
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(said.append)  # otherwise it prints, and writes a file
    try:
        model = _compiled(mujoco, source, free_root, package_dirs, report, said)
    finally:
        mujoco.set_mju_user_warning(before)
    for warning in said:
        report.add("MuJoCo", f"warns: {_line(warning)}", "it compiled the model with this warning")
    for name in dir(model):
        values = getattr(model, name) if name.startswith(READ) else None
        if isinstance(values, np.ndarray) and name not in DERIVED and not np.isfinite(values).all():
            raise ValueError(
                f"the model must be finite, got {values[~np.isfinite(values)][0]} in {name}"
            )
    return model


def _compiled(mujoco, source, free_root: bool, package_dirs, report: Report, said: list) -> Any:
    if isinstance(source, mujoco.MjModel):
        _no_root(free_root, "an MjModel, which is compiled")
        return source
    if isinstance(source, mujoco.MjSpec):
        spec, what, mimics = source, "the MjSpec", []
    elif isinstance(source, (str, os.PathLike)):
        spec, what, mimics = _specification(mujoco, source, package_dirs, report)
    else:
        raise TypeError(
            "source must be a path, an XML text, a mujoco.MjSpec or a mujoco.MjModel, got "
            f"{type(source).__name__}"
        )
    if free_root:
        _free(mujoco, spec, what)
    while True:
        try:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                model = spec.compile()
            break
        except (ValueError, RuntimeError) as error:
            dropped = _drop_picture(mujoco, spec, _line(error), report)
            if not dropped and not drop_visuals(spec, _line(error), report):
                raise ValueError(f"{what} does not compile: {_line(error)}") from None
    said += [warning.message for warning in caught]
    pairs = zip(model.eq_type, model.eq_obj1id)
    coupled = {model.joint(j).name for kind, j in pairs if kind == mujoco.mjtEq.mjEQ_JOINT}
    for name in mimics:
        if name not in coupled:
            report.add(f"joint {name!r}", "MuJoCo does not read its <mimic>", "moves freely")
    return model


def _specification(mujoco, source, package_dirs, report: Report) -> tuple[Any, str, list[str]]:
    """Return the specification in a file or a text, its name, and the joints of a URDF that follow others."""
    if isinstance(source, str) and source.lstrip().startswith("<"):
        text, folder, what = source, None, "the model"
    else:
        path = Path(source)
        if not path.is_file():
            raise FileNotFoundError(f"there is no model file {str(path)!r}")
        text, folder, what = path.read_bytes(), path.resolve().parent, path.name
    root = parsed(text, what)
    if root.tag not in ("mujoco", "robot"):
        raise ValueError(
            f"{what} must be MJCF (root <mujoco>) or URDF (root <robot>), got a root <{root.tag}>"
        )
    check_model(root, what, folder)
    mimics = []
    try:
        if root.tag == "robot":
            mimics = [j.get("name", "") for j in root.iter("joint") if j.find("mimic") is not None]
            tints = colours(root)  # of visuals, which may be left out
            text = prepared(root, folder, package_dirs, report)
            spec = mujoco.MjSpec.from_string(text)
            for geom in spec.geoms:
                geom.rgba = tints.get(geom.parent.name, geom.rgba)
            name_visuals(spec, root, mujoco)
        elif isinstance(text, str):
            spec = mujoco.MjSpec.from_string(text)
        elif _is_utf8(text):
            spec = mujoco.MjSpec.from_file(str(source))
        else:
            spec = _other_encoding(mujoco, root, folder)
    except (ValueError, RuntimeError) as error:
        raise ValueError(f"{what} cannot be read: {_line(error)}") from None
    drop_sizes(spec)
    return spec, what, mimics


def _is_utf8(data: bytes) -> bool:
    """Return whether MuJoCo reads a file as it is: it knows no other encoding."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return b"\0" not in data


def _other_encoding(mujoco, root: ET.Element, folder: Path | None):
    """Return the specification of a model whose file is not in UTF-8."""
    if root.find(".//include") is not None:
        raise ValueError("it includes other files, so it must be in UTF-8")
    spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    spec.modelfiledir = str(folder)
    return spec


def _drop_picture(mujoco, spec, error: str, report: Report) -> bool:
    """Replace the picture that an error is about by a plain texture; return whether it is about one."""
    for texture in spec.textures:
        files = [name for name in (texture.file, *texture.cubefiles) if name]
        if any(Path(name).name in error for name in files):
            texture.file, texture.builtin = "", mujoco.mjtBuiltin.mjBUILTIN_FLAT
            texture.cubefiles, texture.width, texture.height = [""] * 6, 1, 1
            report.add(
                f"texture {texture.name!r}", f"its picture is not read ({error})", "left out"
            )
            return True
    return False


def _free(mujoco, spec, what: str) -> None:
    """Give the one body on the world a free joint."""
    roots = spec.worldbody.bodies
    if len(roots) != 1 or len(roots[0].joints) > 0:
        raise ValueError(
            f"free_root needs a model with one body on the world, without joints; {what} has "
            f"{len(roots)} such bodies, the first with {len(roots[0].joints) if roots else 0} joints"
        )
    roots[0].add_joint(type=mujoco.mjtJoint.mjJNT_FREE)


def _no_root(free_root: bool, what: str) -> None:
    if free_root:
        raise ValueError(f"free_root must be left out with {what}")


def _line(error: Exception | str) -> str:
    """Return a message in one line."""
    return " ".join(str(error).split())
