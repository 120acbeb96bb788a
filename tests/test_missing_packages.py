"""What a missing package needs is in the error, as a line of its own that can be copied."""

import sys

import pytest

import carom


@pytest.fixture(scope="module")
def fallen():
    scene = carom.Scene()
    scene.add_body(carom.Sphere(0.1), mass=1.0)
    return carom.simulate(scene, duration=0.1, step=0.05)


def ensemble(run):
    return carom.ensemble(run.scene, 0.1, step=0.05, runs=2, vary={"body1.mass": [1.0, 2.0]})


@pytest.mark.parametrize(
    ("package", "extra", "use"),
    [
        ("matplotlib.pyplot", "plot", lambda run: run.plot()),
        ("PIL", "film", lambda run: carom.films.still(run)),
        ("pygltflib", "export", lambda run: run.export("run.glb")),
        ("meshio", "export", lambda run: run.export("run.pvd")),
        ("viser", "view", lambda run: carom.view(run)),
        ("mujoco", "models", lambda run: carom.load_model("<mujoco/>")),
        ("trimesh", "shapes", lambda run: carom.Mesh.load("a.stl")),
        ("h5netcdf", "files", lambda run: run.save("run.nc")),
        ("pyarrow", "parquet", lambda run: run.save("run.parquet")),
        ("xarray", "ensemble", lambda run: ensemble(run).to_xarray()),
        ("pandas", "files", lambda run: ensemble(run).to_pandas()),
        ("pyarrow", "parquet", lambda run: ensemble(run).save("runs.parquet")),
        ("h5netcdf", "files", lambda run: ensemble(run).save("runs.nc")),
        ("zarr", "ensemble", lambda run: ensemble(run).save("runs.zarr")),
        ("matplotlib.pyplot", "plot", lambda run: ensemble(run).plot("body1.z")),
        (
            "sympy",
            "sympy",
            lambda run: carom.GeneralizedSystem.from_sympy(
                [], [], position=[], velocity=[], kinetic_energy=0
            ),
        ),
    ],
)
def test_the_last_line_installs_it(package, extra, use, fallen, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ModuleNotFoundError) as caught:
        use(fallen)
    *_, last = str(caught.value).rstrip().splitlines()
    assert last.strip() == f'pip install "carom[{extra}]"'
    assert caught.value.name
