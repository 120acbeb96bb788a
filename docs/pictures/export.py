"""The picture of "Take a run to Blender": the bodies of "See it move", exported, and rendered by Blender.

Run ``python docs/pictures/export.py``, with Blender's own module (``pip install bpy``), to make
``docs/_static/blender.jpg``.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

from throw import OUT, throw

TIME = 0.25  # of the picture [s]


def main() -> None:
    """Export the motion, and render a moment of it."""
    import bpy

    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_scene.gltf(filepath=str(throw().export(Path(folder) / "throw.glb")))
    film = bpy.context.scene
    film.frame_set(int(TIME * film.render.fps), subframe=TIME * film.render.fps % 1.0)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (
        (0.5, -1.0, 0.5),
        (math.radians(73), 0, math.radians(24)),
    )
    lamp = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    lamp.data.energy, lamp.data.angle, lamp.rotation_euler = 2.2, 0.1, (0.6, 0.4, 0)
    for one in (camera, lamp):
        film.collection.objects.link(one)
    film.camera, film.world = camera, bpy.data.worlds.new("sky")
    film.world.color = (0.35, 0.35, 0.35)
    film.view_settings.view_transform = "Standard"
    film.render.engine, film.cycles.samples, film.cycles.use_denoising = "CYCLES", 64, False
    film.render.resolution_x, film.render.resolution_y = 960, 480
    film.render.image_settings.file_format = "JPEG"
    film.render.filepath = str(OUT / "blender.jpg")
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
