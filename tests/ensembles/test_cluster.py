"""A cluster of processes on this machine, of which one is killed in the middle: nothing is lost."""

import os
import signal

import pytest

import carom
from ensembles.ensemble_scenes import die
from ensembles.test_ensemble import THROWN, same


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")  # of the cluster, whose worker is killed
def test_a_killed_worker_loses_nothing():
    distributed = pytest.importorskip("distributed")  # 1 s, and no other test needs it
    given = {"step": 2e-3, "vary": THROWN, "runs": 60}
    alone = carom.ensemble(die(), 0.6, **given)
    killed = []
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):

        def kill_one(done, total):
            if done >= 12 and not killed:
                process = client.run(os.getpid)
                killed.append(next(iter(process.values())))
                os.kill(killed[0], signal.SIGKILL)

        spread = carom.ensemble(die(), 0.6, executor=client, chunk=3, progress=kill_one, **given)
    assert killed
    assert spread.complete
    assert same(alone, spread)
