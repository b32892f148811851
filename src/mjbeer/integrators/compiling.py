"""How numba compiles the functions that step a model, and where their code is kept.

numba takes longer to import than everything else together, so that only what needs compiled code
imports this file.
"""

import gc
import threading
from collections.abc import Generator
from contextlib import contextmanager
from functools import partial
from typing import Any

from llvmlite import ir
from numba import njit, types
from numba.core import event
from numba.extending import intrinsic

from mjbeer.integrators.kernel_cache import compile_and_keep

_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",  # a division by zero gives an infinity
    "nogil": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,  # compiled functions allocate nothing, so that no references need to be counted
}
kernel = partial(compile_and_keep, **_OPTIONS)
"""Decorates what Python calls. The code is kept on disk for later processes."""
compiled = partial(njit, no_cpython_wrapper=True, **_OPTIONS)
"""Decorates what only compiled code calls."""
inlined = partial(compiled, forceinline=True)
"""Decorates what is compiled into its callers: a call would take as long as its work."""


@intrinsic
def optimize_for_size(typing_context):
    """Have the calling function compiled to little code.

    Its loops are short, and unrolling them would take seconds.
    """

    def generate(context, builder, signature, arguments):
        builder.function.attributes.add("optsize")
        return context.get_dummy_value()

    return types.void(), generate


@intrinsic
def call_c(typing_context, function, model, data):
    """Call the C function of an mjModel and an mjData at the address `function`.

    The addresses are arguments, and not compiled in, so that the code can be kept for other
    processes.
    """

    def generate(context, builder, signature, arguments):
        pointers = arguments[1:]
        function_type = ir.FunctionType(ir.VoidType(), [pointer.type for pointer in pointers])
        builder.call(builder.inttoptr(arguments[0], function_type.as_pointer()), pointers)
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@contextmanager
def announced() -> Generator[None]:
    """Print a notice in a terminal if compiling takes over a second.

    Loading kept code prints none.
    """

    def notify() -> None:
        from mjbeer.output import terminal  # takes a tenth of a second to import

        if compilations.buffer and (terminal.STDERR.is_terminal or terminal.STDERR.is_jupyter):
            terminal.say("mjbeer: compiling this integrator for this machine, once: some 5 s")

    timer = threading.Timer(1.0, notify)
    collects = gc.isenabled()
    with event.install_recorder("numba:compile") as compilations:
        timer.start()
        gc.disable()  # it would take a tenth of the compiler's time, and find nothing
        try:
            yield
        finally:
            timer.cancel()
            if collects:
                gc.enable()
