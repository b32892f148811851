"""Calls C functions of the loaded MuJoCo library from compiled code, so that no Python runs between them."""

import ctypes

from llvmlite import ir
from numba import types
from numba.extending import intrinsic


@intrinsic
def call(typing_context, function, model, data):
    """Call the C function at the address `function` with two pointers; no address is compiled in, so caching works."""

    def generate(context, builder, signature, arguments):
        pointer = ir.IntType(8 * ctypes.sizeof(ctypes.c_void_p))
        function_type = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        builder.call(builder.inttoptr(arguments[0], function_type.as_pointer()), arguments[1:])
        return context.get_dummy_value()

    return types.void(types.intp, types.intp, types.intp), generate


@intrinsic
def small(typing_context):
    """Compile the function that calls this for size: its loops over a few joints gain nothing from more code."""

    def generate(context, builder, signature, arguments):
        builder.function.attributes.add("optsize")
        return context.get_dummy_value()

    return types.void(), generate


@intrinsic
def apart(typing_context):
    """Keep the function that calls this from being copied into its callers, which would take the compiler seconds."""

    def generate(context, builder, signature, arguments):
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return types.void(), generate
