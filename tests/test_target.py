"""Numba is a guest: nothing of it is replaced; what is compiled is for a fixed processor."""

import os
import subprocess
import sys

import llvmlite.binding as llvm
import numba
import pytest
from numba.core import config, itanium_mangler, types
from numba.core.targetconfig import TargetConfig
from numba.np import linalg

from carom._compiled.by_reference import Reference, type_of
from carom.model.controls import Controls

CODE = "from carom._compiled.target import processor; print(*processor()[:1])"


def processor(**environment) -> str:
    """What a new process would compile for."""
    known = {k: v for k, v in os.environ.items() if not k.startswith(("NUMBA_CPU", "CAROM_"))}
    told = subprocess.run(
        [sys.executable, "-c", CODE], env={**known, **environment}, capture_output=True, text=True, check=True
    )  # fmt: skip
    return told.stdout.strip()


@pytest.mark.skipif(not llvm.get_process_triple().startswith("x86_64"), reason="for x86-64")
def test_the_processor_is_a_baseline_unless_another_is_asked_for():
    modern = llvm.get_host_cpu_features().get("avx2", False)
    assert processor() == ("x86-64-v3" if modern else llvm.get_host_cpu_name())
    assert processor(CAROM_NATIVE="1") == llvm.get_host_cpu_name()
    assert processor(NUMBA_CPU_NAME="generic") == "generic"


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_nothing_is_replaced_in_numba():
    import carom.stepping.time_loop  # noqa: F401  all kernels

    for one in (
        TargetConfig.__eq__, TargetConfig.__hash__, types.Function.get_call_type, itanium_mangler.mangle_args,
        numba.core.typing.typeof.typeof_impl.dispatch(tuple), linalg.ensure_blas,
    ):  # fmt: skip
        assert one.__module__.startswith("numba.")


def test_named_tuples_are_references_for_us_and_tuples_for_others():
    controls = Controls(*[0.0] * len(Controls._fields))
    assert isinstance(type_of(controls), Reference)
    assert isinstance(numba.typeof(controls), types.BaseNamedTuple)
