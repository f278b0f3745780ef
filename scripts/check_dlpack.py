#!/usr/bin/env python3
"""Fields through DLPack: where they are, and that they are the state itself, by the driver and by what there is of PyTorch, cupy and JAX.

    PYTHONPATH=build/cuda/python scripts/check_dlpack.py [--device cuda] CASE...

Of each case 300 steps are taken on the device and on the processor. Exit code 1 if a bit differs."""
import argparse
import ctypes
import importlib
import sys

import numpy

import breccia as br

PLACES = {1: "kDLCPU", 2: "kDLCUDA"}
failures = []


class Tensor(ctypes.Structure):
    """DLTensor of dlpack.h."""

    _fields_ = [
        ("data", ctypes.c_void_p), ("device_type", ctypes.c_int32), ("device_id", ctypes.c_int32), ("ndim", ctypes.c_int32),
        ("code", ctypes.c_uint8), ("bits", ctypes.c_uint8), ("lanes", ctypes.c_uint16),
        ("shape", ctypes.POINTER(ctypes.c_int64)), ("strides", ctypes.POINTER(ctypes.c_int64)), ("byte_offset", ctypes.c_uint64),
    ]


ctypes.pythonapi.PyCapsule_GetPointer.restype = ctypes.c_void_p
ctypes.pythonapi.PyCapsule_GetPointer.argtypes = [ctypes.py_object, ctypes.c_char_p]


def tensor_in(capsule):
    return Tensor.from_address(ctypes.pythonapi.PyCapsule_GetPointer(capsule, b"dltensor"))


class Driver:
    """NVIDIA's driver: whose memory an address is, and what is there."""

    def __init__(self):
        self.lib = ctypes.CDLL("libcuda.so.1")
        context = ctypes.c_void_p()
        self.call("cuInit", 0)
        self.call("cuDevicePrimaryCtxRetain", ctypes.byref(context), 0)
        self.call("cuCtxSetCurrent", context)

    def call(self, name, *arguments):
        code = getattr(self.lib, name)(*arguments)
        if code != 0:
            raise RuntimeError(f"{name}: error {code} of the driver")

    def is_of_device(self, address):
        kind = ctypes.c_uint()
        self.call("cuPointerGetAttribute", ctypes.byref(kind), 2, ctypes.c_uint64(address))  # CU_POINTER_ATTRIBUTE_MEMORY_TYPE
        return kind.value == 2  # CU_MEMORYTYPE_DEVICE

    def copy(self, tensor):
        shape = tuple(tensor.shape[k] for k in range(tensor.ndim))
        size = tensor.bits // 8
        dtype = numpy.dtype({0: "i", 1: "u", 2: "f"}[tensor.code] + str(size))
        if 0 in shape:
            return numpy.empty(shape, dtype)
        dense = [int(numpy.prod(shape[k + 1:])) for k in range(tensor.ndim)]
        steps = [tensor.strides[k] for k in range(tensor.ndim)] if tensor.strides else dense
        span = (sum((n - 1) * s for n, s in zip(shape, steps)) + 1) * size
        memory = ctypes.create_string_buffer(span)
        self.call("cuMemcpyDtoH_v2", memory, ctypes.c_uint64(tensor.data + tensor.byte_offset), ctypes.c_size_t(span))
        view = numpy.lib.stride_tricks.as_strided(numpy.frombuffer(memory, dtype), shape, [s * size for s in steps])
        return numpy.ascontiguousarray(view)


def takers():
    """Those that take a tensor and give it back to numpy."""
    found = {}
    for name, to_host in (("torch", lambda a: a.cpu().numpy()), ("cupy", lambda a: a.get()), ("jax", numpy.asarray)):
        try:
            module = importlib.import_module(name)
        except ImportError:
            continue
        if name == "jax":
            module.config.update("jax_enable_x64", True)
            module = importlib.import_module("jax.dlpack")
        found[name] = (module.from_dlpack, to_host)
    return found


def expect(holds, what):
    if not holds:
        failures.append(what)
        print("  WRONG", what, flush=True)


def compare(case, device, others, driver):
    cpu, gpu = br.Simulation(case), br.Simulation(case, device=device)
    cpu.step(300), gpu.step(300)
    expect(cpu.hash == gpu.hash, f"{case}: hash {gpu.hash}, of the processor {cpu.hash}")
    there = []
    for name in gpu.fields:
        field = gpu.fields.tensor(name)
        capsule = field.__dlpack__()
        tensor = tensor_in(capsule)
        host = numpy.array(cpu.fields[name])
        expect((tensor.device_type, tensor.device_id) == tuple(field.__dlpack_device__()), f"{name}: capsule and __dlpack_device__ agree")
        if PLACES[tensor.device_type] == "kDLCPU":
            expect(numpy.from_dlpack(field).tobytes() == host.tobytes(), f"{name}: numpy has the processor's bits")
            continue
        there.append(name)
        expect(driver.is_of_device(tensor.data), f"{name}: the address is of the device's memory")
        expect(driver.copy(tensor).tobytes() == host.tobytes(), f"{name}: the driver copies the processor's bits")
        for taker, (take, to_host) in others.items():
            try:
                taken = take(field)
            except Exception as error:
                expect(taker == "jax", f"{name}: {taker}: {error}")  # which takes no strides
                continue
            expect(numpy.ascontiguousarray(to_host(taken)).tobytes() == host.tobytes(), f"{name}: {taker} has the processor's bits")
    if driver:
        expect(there, "fields are on the device")
        capsule = gpu.fields.tensor("velocity").__dlpack__()
        tensor, before = tensor_in(capsule), driver.copy(tensor_in(capsule))
        gpu.step(10), cpu.step(10)
        del gpu  # the capsule keeps its memory
        after = driver.copy(tensor)
        expect(not numpy.array_equal(before, after), "velocity follows the steps without a copy")
        expect(after.tobytes() == numpy.array(cpu.fields["velocity"]).tobytes(), "velocity has the processor's bits ten steps later")
    print(f"{case}: {len(there)} of {len(list(cpu.fields))} fields on the device, seen by {', '.join((['the driver'] if driver else ['numpy']) + list(others))}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cuda")
    parser.add_argument("case", nargs="+")
    given = parser.parse_args()
    others = takers()
    driver = None if given.device == "cpu" else Driver()
    for case in given.case:
        compare(case, given.device, others, driver)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
