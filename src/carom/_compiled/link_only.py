"""Compile a kernel as a part of its callers: it is lowered once, linked in, and optimised only with the whole.

Numba optimises each function together with all that it calls, and makes machine code of it, although a kernel
is never called separately: a function ten calls deep is optimised ten times. Here a kernel stays LLVM code that
its callers link in. Only functions called from Python or through an address are optimised, once, with all their
parts. (Measured on a die thrown to rest: docs/development/decisions.md.)
"""

from __future__ import annotations

from typing import Any

from numba import _dynfunc  # pyright: ignore[reportAttributeAccessIssue]
from numba.core import compiler, typed_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler_machinery import register_pass


class Part(JITCodeLibrary):
    """Code that is only linked into other code."""

    def _optimize_final_module(self):
        pass  # only its callers are optimised

    def _finalize_final_module(self):
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def get_pointer_to_function(self, name):
        """Return 0, because there is no machine code."""
        return 0


@register_pass(mutates_CFG=True, analysis_only=False)
class PartLowering(typed_passes.NativeLowering):
    """Lower a kernel into a `Part`, which is not compiled further."""

    _name = "part_lowering"

    def run_pass(self, state):
        """Write the code of the kernel, and register it for its callers."""
        context, flags = state.targetctx, state.flags
        state.library = Part(context.codegen(), state.func_id.func_qualname)
        kept, flags.no_compile = flags.no_compile, True
        try:
            super().run_pass(state)
        finally:
            flags.no_compile = kept
        made: Any = state["cr"]
        function = made.fndesc
        # the object by which callers refer to it; it has no machine code and cannot be called
        entry = _dynfunc.make_function(
            function.lookup_module(), function.qualname, "", 0, made.env, (state.library,)
        )
        context.insert_user_function(entry, function, [state.library])
        state.reload_init.extend(getattr(state.library, "_reload_init", ()))  # not in Numba 0.61
        state["cr"] = made._replace(cfunc=entry)
        return True


class PartCompiler(compiler.CompilerBase):
    """Numba's own pipeline with another last pass."""

    lowering = PartLowering

    def define_pipelines(self):
        """Return the passes."""
        manager = compiler.DefaultPassBuilder.define_nopython_pipeline(self.state)
        manager.passes[:] = [
            (self.lowering if step is typed_passes.NativeLowering else step, what)
            for step, what in manager.passes
        ]
        return [manager]
