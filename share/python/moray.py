# SPDX-License-Identifier: MIT
"""Optimal control from Python: a problem written as Python functions of numpy arrays, solved and certified by moray.

    import moray
    wire = moray.Phase(nx=3, nu=1, rates=slide, t0=0, tf=(0.1, 10), x0=[0, 10, 0], xf=[10, 5, None], u=[(0, 3.1416)])
    found = moray.solve([wire], lambda phases, s: phases[0].tf)
    found.objective, found.certified, found.phases[0].t, found.phases[0].x

A bound is a number (fixed), a pair (low, high) with None for an end that is open, or None (free).
rates(x, u, s, t) returns the derivatives of the states, or a tuple (derivatives, path constraints, integrands).
endpoint(phases, s) returns what is minimised, or a tuple (that, events); phases[i] has x0, t0, xf, tf and q.
Derivatives are differences of these functions, so they should be smooth. The library is the one that MORAY_LIBRARY
names, else the one installed, else that of the source tree's folder build.
"""
import ctypes as c
import math
import os

import numpy as np

_double_p = c.POINTER(c.c_double)


class _Bounds(c.Structure):
    _fields_ = [("lower", c.c_double), ("upper", c.c_double)]


class _List(c.Structure):
    _fields_ = [("at", c.POINTER(_Bounds)), ("n", c.c_int)]


class _Status(c.Structure):
    _fields_ = [("code", c.c_int), ("text", c.c_char * 300)]


class _Node(c.Structure):
    _fields_ = [("x", _double_p), ("u", _double_p), ("s", _double_p), ("t", c.c_double)]


class _Rates(c.Structure):
    _fields_ = [("f", _double_p), ("c", _double_p), ("g", _double_p)]


class _PhaseEnds(c.Structure):
    _fields_ = [("x0", _double_p), ("xf", _double_p), ("q", _double_p), ("t0", c.c_double), ("tf", c.c_double),
                ("u0", _double_p), ("uf", _double_p)]


class _Ends(c.Structure):
    _fields_ = [("phase", c.POINTER(_PhaseEnds)), ("s", _double_p)]


class _EndValues(c.Structure):
    _fields_ = [("objective", c.c_double), ("e", _double_p)]


_continuous = c.CFUNCTYPE(None, c.POINTER(_Node), c.POINTER(_Rates), c.c_void_p)
_endpoint = c.CFUNCTYPE(None, c.POINTER(_Ends), c.POINTER(_EndValues), c.c_void_p)


class _Observations(c.Structure):
    _fields_ = [("n", c.c_int), ("ny", c.c_int), ("time", _double_p), ("value", _double_p), ("weight", _double_p),
                ("observe", c.c_void_p), ("map", c.c_void_p), ("names", c.c_void_p), ("loss", c.c_int),
                ("threshold", c.c_double), ("residual", _List), ("sum", _Bounds), ("events_only", c.c_bool)]


class _PhaseSpec(c.Structure):
    _fields_ = [("name", c.c_char_p), ("nx", c.c_int), ("nu", c.c_int), ("nc", c.c_int), ("nq", c.c_int),
                ("continuous", c.c_void_p), ("map", c.c_void_p), ("t0", _Bounds), ("tf", _Bounds),
                ("duration", _Bounds), ("mesh", _double_p), ("intervals", c.c_int), ("x", _List), ("x0", _List),
                ("xf", _List), ("u", _List), ("c", _List), ("q", _List), ("x_names", c.POINTER(c.c_char_p)),
                ("u_names", c.POINTER(c.c_char_p)), ("c_names", c.POINTER(c.c_char_p)),
                ("continuous_real", _continuous), ("observed", _Observations), ("u0", _List), ("uf", _List),
                ("end_controls", c.c_bool), ("held", c.POINTER(c.c_bool)), ("scheme", c.c_char_p)]


class _OcpSpec(c.Structure):
    _fields_ = [("name", c.c_char_p), ("phases", c.c_int), ("ns", c.c_int), ("ne", c.c_int),
                ("phase", c.POINTER(_PhaseSpec)), ("endpoint", c.c_void_p), ("endpoint_map", c.c_void_p), ("s", _List),
                ("e", _List), ("s_names", c.POINTER(c.c_char_p)), ("e_names", c.POINTER(c.c_char_p)),
                ("data", c.c_void_p), ("endpoint_real", _endpoint)]


class _Samples(c.Structure):
    _fields_ = [("n", c.c_int), ("time", _double_p), ("x", _double_p), ("u", _double_p)]


class _Guess(c.Structure):
    _fields_ = [("phase", c.POINTER(_Samples)), ("s", _double_p), ("from_", c.c_void_p), ("owned", c.c_void_p),
                ("along_time", c.c_bool)]


class _Progress(c.Structure):
    pass  # never looked into


_progress = c.CFUNCTYPE(c.c_bool, c.c_void_p, c.POINTER(_Progress))


class _Settings(c.Structure):
    _fields_ = [("scheme", c.c_char_p), ("intervals", c.c_int), ("tolerance", c.c_double),
                ("mesh_tolerance", c.c_double), ("max_refinements", c.c_int), ("max_iterations", c.c_int),
                ("max_cpu_seconds", c.c_double), ("max_variables", c.c_int), ("barrier", c.c_double), ("barrier_shared", c.c_bool),
                ("rough", c.c_bool), ("own_scaling", c.c_bool), ("gauss_newton", c.c_bool), ("print_level", c.c_int),
                ("linear_solver", c.c_int), ("timing", c.c_bool), ("ipopt", c.c_void_p), ("n_ipopt", c.c_int),
                ("progress", _progress), ("observer", c.c_void_p)]


class _SimSettings(c.Structure):
    _fields_ = [("method", c.c_int), ("rtol", c.c_double), ("atol", c.c_double), ("max_step", c.c_double),
                ("max_steps", c.c_long)]


class _Integrator(c.Structure):
    _fields_ = [("run", c.c_void_p), ("self", c.c_void_p)]


_certificate_numbers = ("kkt", "mesh_error", "between_nodes", "resimulation", "derivatives", "directions",
                        "hamiltonian", "gap", "curvature", "composed", "untold", "unseen",
                        "mesh_limit")


class _Certificate(c.Structure):
    _fields_ = [("pass_", c.c_bool)] + [(name, c.c_double) for name in _certificate_numbers] + [("why", c.c_char * 400)]


# What a test compares with the headers.
STRUCTURES = {"moray_bounds": _Bounds, "moray_bounds_list": _List, "moray_status": _Status, "moray_real_node": _Node,
              "moray_real_rates": _Rates, "moray_real_phase_ends": _PhaseEnds, "moray_real_ends": _Ends,
              "moray_real_end_values": _EndValues, "moray_observations": _Observations, "moray_phase_spec": _PhaseSpec,
              "moray_ocp_spec": _OcpSpec, "moray_samples": _Samples, "moray_guess": _Guess,
              "moray_settings": _Settings, "moray_sim_settings": _SimSettings, "moray_integrator": _Integrator,
              "moray_certificate": _Certificate}


def _open():
    """The library that MORAY_LIBRARY names, the one that the loader finds, or the source tree's own."""
    tree = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "build", "libmoray.so.0")
    named = os.environ.get("MORAY_LIBRARY")
    try:
        return c.CDLL(named or "libmoray.so.0")
    except OSError as error:
        if not named and os.path.exists(tree):
            return c.CDLL(tree)
        raise ImportError(f"moray's library is not to be had: {error}; install it, build it in the source tree, "
                          "or name it in MORAY_LIBRARY") from None


def _load():
    library = _open()
    solution = c.c_void_p
    for name, result, arguments in (
            ("moray_version", c.c_char_p, []),
            ("moray_ocp_new", _Status, [c.POINTER(c.c_void_p), c.POINTER(_OcpSpec)]),
            ("moray_ocp_free", None, [c.c_void_p]),
            ("moray_settings_default", _Settings, []),
            ("moray_solve", _Status, [c.c_void_p, c.POINTER(_Settings), c.POINTER(_Guess), c.POINTER(solution)]),
            ("moray_solution_free", None, [solution]),
            ("moray_solution_info", c.POINTER(c.c_int), [solution]),  # which begins with the outcome
            ("moray_solution_objective", c.c_double, [solution]),
            ("moray_solution_parameters", _double_p, [solution]),
            ("moray_solution_integrals", _double_p, [solution, c.c_int]),
            ("moray_solution_at", None, [solution, c.c_int, c.c_double, _double_p, _double_p]),
            ("moray_solution_nodes", c.c_int, [solution, c.c_int, _double_p, _double_p]),
            ("moray_solution_diagnosis", c.c_char_p, [solution]),
            ("moray_sim_settings_default", _SimSettings, []),
            ("moray_sim_integrator", _Integrator, [c.POINTER(_SimSettings)]),
            ("moray_certify", _Status, [solution, c.POINTER(_Integrator), c.POINTER(_Certificate)])):
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


_library = _load()
VERSION = _library.moray_version().decode()


class Error(Exception):
    """What the library refuses or fails in; the text names the thing, its value and what is allowed."""


def _try(status):
    if status.code:
        raise Error(status.text.decode(errors="replace"))


def _bound(value, what):
    low, high = value if isinstance(value, (tuple, list)) else (value, value)
    try:
        return _Bounds(-1e20 if low is None else float(low), 1e20 if high is None else float(high))
    except (TypeError, ValueError):
        raise Error(f"{what} = {value}: must be a number, a pair of numbers, or None") from None


def _list(values, n, what, keep):
    if values is None:
        return _List()
    if len(values) != n:
        raise Error(f"{what} has {len(values)} bounds: must have {n}")
    array = (_Bounds * n)(*[_bound(value, f"{what}[{k}]") for k, value in enumerate(values)])
    keep.append(array)
    return _List(c.cast(array, c.POINTER(_Bounds)), n)


def _names(names, n, what, keep):
    if names is None:
        return None
    if len(names) != n:
        raise Error(f"{what} has {len(names)} names: must have {n}")
    array = (c.c_char_p * max(n, 1))(*[name.encode() for name in names])
    keep.append(array)
    return c.cast(array, c.POINTER(c.c_char_p))


def _view(pointer, n):
    return np.ctypeslib.as_array(pointer, (n,)).copy() if n else np.zeros(0)


def _put(pointer, values, n, what):
    array = np.asarray(values, dtype=float).reshape(-1)
    if array.size != n:
        raise Error(f"{what}: {array.size} numbers are returned, must be {n}")
    for k in range(n):
        pointer[k] = array[k]


class Phase:
    """A phase: nx states, nu controls, nc path constraints, nq integrals, and rates(x, u, s, t). guess: (t, x, u)."""

    def __init__(self, nx, nu, rates, *, nc=0, nq=0, name=None, t0=0, tf=None, x=None, x0=None, xf=None, u=None,
                 c=None, q=None, x_names=None, u_names=None, c_names=None, intervals=0, scheme=None,
                 guess=None):
        self.nx, self.nu, self.nc, self.nq, self.rates, self.name = nx, nu, nc, nq, rates, name
        self.bounds = {"x": (x, nx), "x0": (x0, nx), "xf": (xf, nx), "u": (u, nu), "c": (c, nc), "q": (q, nq)}
        self.names = {"x_names": (x_names, nx), "u_names": (u_names, nu), "c_names": (c_names, nc)}
        self.t0, self.tf, self.intervals, self.scheme, self.guess = t0, tf, intervals, scheme, guess


class Ends:
    """The ends of a phase: states x0 and xf at times t0 and tf, integrals q."""

    def __init__(self, at, phase):
        self.x0, self.xf = _view(at.x0, phase.nx), _view(at.xf, phase.nx)
        self.q, self.t0, self.tf = _view(at.q, phase.nq), at.t0, at.tf


class Trajectory:
    """A phase of a solution: t[n], x[n, nx], u[n, nu] at its nodes, integrals q; at(t) between them."""

    def __init__(self, solution, k, phase):
        self._solution, self._k, self._phase = solution, k, phase
        handle = solution._handle
        n = _library.moray_solution_nodes(handle, k, None, None)
        self.t = np.zeros(n)
        self.costates = np.zeros((n, phase.nx))
        _library.moray_solution_nodes(handle, k, self.t.ctypes.data_as(_double_p),
                                      self.costates.ctypes.data_as(_double_p))
        self.x, self.u = self.at(self.t)
        self.q = _view(_library.moray_solution_integrals(handle, k), phase.nq)

    def at(self, t):
        """States and controls at a time, or arrays of them at an array of times."""
        times = np.atleast_1d(np.asarray(t, dtype=float))
        x, u = np.zeros((times.size, self._phase.nx)), np.zeros((times.size, self._phase.nu))
        for k, time in enumerate(times):
            _library.moray_solution_at(self._solution._handle, self._k, time, x[k].ctypes.data_as(_double_p),
                                       u[k].ctypes.data_as(_double_p))
        return (x[0], u[0]) if np.ndim(t) == 0 else (x, u)


class Solution:
    """What was found: solved, objective, parameters s, phases, diagnosis; certified, certificate (its numbers), why."""

    def __init__(self, problem, handle):
        self._problem, self._handle = problem, handle
        self.solved = _library.moray_solution_info(handle)[0] == 0
        self.objective = _library.moray_solution_objective(handle)
        self.s = _view(_library.moray_solution_parameters(handle), problem.ns)
        self.phases = [Trajectory(self, k, phase) for k, phase in enumerate(problem.phases)]
        self.diagnosis = _library.moray_solution_diagnosis(handle).decode()
        self.certified, self.certificate, self.why = False, {}, "not solved"
        if self.solved:
            self._certify()

    def _certify(self):
        found, sim = _Certificate(), _library.moray_sim_settings_default()
        integrator = _library.moray_sim_integrator(c.byref(sim))
        _try(_library.moray_certify(self._handle, c.byref(integrator), c.byref(found)))
        self._problem.raise_what_failed()
        self.certified, self.why = found.pass_, found.why.decode()
        self.certificate = {name: getattr(found, name) for name in _certificate_numbers}

    def __del__(self):
        if getattr(self, "_handle", None):
            _library.moray_solution_free(self._handle)


class _Problem:
    """The problem as the library has it, with all that it points to."""

    def __init__(self, phases, endpoint, ns, ne, s, e, name, s_names, e_names):
        self.phases, self.endpoint, self.ns, self.ne = list(phases), endpoint, ns, ne
        self.keep, self.failure, self.handle = [], None, c.c_void_p()
        specs = (_PhaseSpec * len(self.phases))(*[self._phase(phase) for phase in self.phases])
        self.end = _endpoint(self._end)
        self.spec = _OcpSpec(name=name.encode(), phases=len(self.phases), ns=ns, ne=ne, phase=specs,
                             s=_list(s, ns, "s", self.keep), e=_list(e, ne, "e", self.keep),
                             s_names=_names(s_names, ns, "s_names", self.keep),
                             e_names=_names(e_names, ne, "e_names", self.keep), endpoint_real=self.end)
        self.keep.append(specs)
        status = _library.moray_ocp_new(c.byref(self.handle), c.byref(self.spec))
        self.raise_what_failed()
        _try(status)

    def __del__(self):
        if getattr(self, "handle", None):
            _library.moray_ocp_free(self.handle)

    def raise_what_failed(self):
        """An exception of a user's function, which could not pass through the library."""
        if self.failure:
            failure, self.failure = self.failure, None
            raise failure

    def _phase(self, phase):
        def continuous(at, out, _):
            try:
                at, out = at[0], out[0]
                values = phase.rates(_view(at.x, phase.nx), _view(at.u, phase.nu), _view(at.s, self.ns), at.t)
                f, path, g = (tuple(values) + ([], []))[:3] if isinstance(values, tuple) else (values, [], [])
                _put(out.f, f, phase.nx, "derivatives of rates")
                _put(out.c, path, phase.nc, "path constraints of rates")
                _put(out.g, g, phase.nq, "integrands of rates")
            except BaseException as failure:
                self.failure = self.failure or failure
                for k in range(phase.nx):
                    out.f[k] = math.nan

        call = _continuous(continuous)
        self.keep.append(call)
        spec = _PhaseSpec(name=phase.name.encode() if phase.name else None, nx=phase.nx, nu=phase.nu, nc=phase.nc,
                          nq=phase.nq, t0=_bound((None, None) if phase.t0 is None else phase.t0, "t0"),
                          tf=_bound((None, None) if phase.tf is None else phase.tf, "tf"), intervals=phase.intervals,
                          scheme=phase.scheme.encode() if phase.scheme else None, continuous_real=call)
        for key, (values, n) in phase.bounds.items():
            values = values if values is None else [(None, None) if one is None else one for one in values]
            setattr(spec, key, _list(values, n, key, self.keep))
        for key, (values, n) in phase.names.items():
            setattr(spec, key, _names(values, n, key, self.keep))
        return spec

    def _end(self, at, out, _):
        try:
            at, out = at[0], out[0]
            ends = [Ends(at.phase[k], phase) for k, phase in enumerate(self.phases)]
            values = self.endpoint(ends, _view(at.s, self.ns))
            objective, e = values if isinstance(values, tuple) else (values, [])
            out.objective = objective
            _put(out.e, e, self.ne, "events of endpoint")
        except BaseException as failure:
            self.failure = self.failure or failure
            out.objective = math.nan

    def guess(self, s):
        """From the guesses of the phases; None where there is none."""
        if s is None and all(phase.guess is None for phase in self.phases):
            return None
        samples = (_Samples * len(self.phases))()
        for k, phase in enumerate(self.phases):
            if phase.guess is None:
                continue
            t, x, u = phase.guess
            t = np.ascontiguousarray(t, dtype=float)
            x = np.ascontiguousarray(x, dtype=float).reshape(t.size, phase.nx)
            u = np.ascontiguousarray(u, dtype=float).reshape(t.size, phase.nu)
            self.keep += [t, x, u]
            samples[k] = _Samples(t.size, *[array.ctypes.data_as(_double_p) for array in (t, x, u)])
        values = None if s is None else np.ascontiguousarray(s, dtype=float)
        self.keep += [samples, values]
        return _Guess(samples, None if values is None else values.ctypes.data_as(_double_p))


def solve(phases, endpoint, *, ns=0, ne=0, s=None, e=None, name="python", s_names=None, e_names=None, s_guess=None,
          **settings):
    """Solves and certifies. Further settings are those of moray_settings: intervals, scheme, tolerance, ..."""
    problem = _Problem(phases, endpoint, ns, ne, s, e, name, s_names, e_names)
    chosen = _library.moray_settings_default()
    chosen.max_refinements = 10
    for key, value in settings.items():
        if key not in dict(_Settings._fields_) or key in ("ipopt", "n_ipopt", "progress", "observer"):
            raise Error(f"there is no setting {key}")
        setattr(chosen, key, value.encode() if isinstance(value, str) else value)
    going_on = _progress(lambda *_: problem.failure is None)  # an exception ends the solve
    chosen.progress = going_on
    guess, handle = problem.guess(s_guess), c.c_void_p()
    status = _library.moray_solve(problem.handle, c.byref(chosen), c.byref(guess) if guess else None, c.byref(handle))
    try:
        problem.raise_what_failed()
        _try(status)
    except BaseException:
        if handle:
            _library.moray_solution_free(handle)
        raise
    return Solution(problem, handle)
