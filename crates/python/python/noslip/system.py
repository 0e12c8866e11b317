"""A system of one's own: a Lagrangian and velocity constraints, as text or as SymPy expressions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import tomli_w
from numpy.typing import NDArray

from ._noslip import RequestError
from .expressions import name, refuse_twins, text
from .results import Run
from .scenes import Scene

Values = Mapping[Any, float] | Sequence[float] | NDArray[Any] | None


class System(Scene):
    """A mechanical system with velocity constraints.

    `coordinates` are names with their units (`"angle"` is in rad, and every formula is the same a turn further; `"rad"` counts
    turns), or a list of names or of SymPy's `dynamicsymbols`.
    `lagrangian`, `constraints` (equations, or what is zero, affine in the rates), `forces` (by coordinate), `positions` (the same of
    coordinates and time), `basis` (admissible velocities, lists of a text for each coordinate) and `outputs` (further columns, by
    name: a text, or a pair of a text and its unit) are texts as in scene files, where `x'` is the rate of `x`, or SymPy expressions.
    Constraints may have names, as a mapping: outputs may contain the force `lambda_NAME` of a constraint, `lambda1`, .. without names.
    `parameters` are numbers by name.

    `q` and `v` are the start, by name or in order. Rates that are left out, and those that violate a constraint, are the nearest
    admissible ones.
    """

    def __init__(
        self,
        coordinates: Mapping[Any, str] | Iterable[Any],
        lagrangian: Any,
        constraints: Mapping[str, Any] | Iterable[Any] = (),
        *,
        parameters: Mapping[Any, float] | None = None,
        forces: Mapping[Any, Any] | None = None,
        positions: Mapping[str, Any] | Iterable[Any] = (),
        basis: Iterable[Iterable[Any]] = (),
        outputs: Mapping[str, Any] | None = None,
        q: Values = None,
        v: Values = None,
        method: str = "dla",
        step: float = 0.01,
        duration: float = 10.0,
        title: str | None = None,
    ) -> None:
        units = coordinates if isinstance(coordinates, Mapping) else dict.fromkeys(coordinates, "1")
        (rows, further), (places, left) = _rows(constraints), _rows(positions)
        basis, forces, parameters = [list(vector) for vector in basis], forces or {}, parameters or {}
        told = {key: output if isinstance(output, tuple) else (output, "") for key, output in (outputs or {}).items()}
        entries = (entry for vector in basis for entry in vector)
        formulas = (formula for formula, _ in told.values())
        texts = [lagrangian, *further, *left, *entries, *forces.values(), *formulas]
        refuse_twins([*units, *parameters, *forces, *texts])
        self.coordinates = [name(coordinate) for coordinate in units]
        system: dict[str, Any] = {
            "coordinates": dict(zip(self.coordinates, units.values(), strict=True)),
            "parameters": {name(key): float(value) for key, value in parameters.items()},
            "lagrangian": text(lagrangian),
            "constraints": rows,
        }
        optional = {
            "forces": {name(key): text(force) for key, force in forces.items()},
            "positions": places,
            "basis": [[text(entry) for entry in vector] for vector in basis],
            "outputs": {
                key: {"formula": text(formula), "unit": unit} if unit else text(formula)
                for key, (formula, unit) in told.items()
            },
        }
        system.update({key: value for key, value in optional.items() if value})
        self._tables: dict[str, Any] = {
            "system": system,
            "start": {**_named(self.coordinates, q, ""), **_named(self.coordinates, v, "'")},
            "run": {"method": method, "step": float(step), "duration": float(duration)},
        }
        if title is not None:
            self._tables["title"] = title
        super().__init__(tomli_w.dumps(self._tables), "system")

    @classmethod
    def _of(cls, tables: dict[str, Any]) -> System:
        """The system of these tables."""
        made = cls.__new__(cls)
        made._tables, made.coordinates = tables, list(tables["system"]["coordinates"])
        Scene.__init__(made, tomli_w.dumps(tables), "system")
        return made

    @classmethod
    def from_lagranges(cls, method: Any, parameters: Mapping[Any, float] | None = None, **settings: Any) -> System:
        """The system of a `sympy.physics.mechanics.LagrangesMethod`, its forces and constraints included."""
        from .mechanics import of_lagranges

        return cls(**{**of_lagranges(method), "parameters": parameters, **settings})

    @classmethod
    def from_kanes(cls, method: Any, parameters: Mapping[Any, float] | None = None, **settings: Any) -> System:
        """The system of a `sympy.physics.mechanics.KanesMethod`, its loads and constraints included.

        The start is given by rates of coordinates, as for any system, not by generalised speeds. Bodies whose velocities have
        constraints put into them already are refused.
        """
        from .mechanics import of_kanes

        return cls(**{**of_kanes(method), "parameters": parameters, **settings})

    def __reduce__(self) -> tuple[Any, ...]:
        return System._of, (self._tables,)

    def started(self, q: Values = None, v: Values = None) -> System:
        """The same system with another start."""
        start = dict(self._tables["start"])
        start.update(_named(self.coordinates, q, ""))
        start.update(_named(self.coordinates, v, "'"))
        return self._of({**self._tables, "start": start})

    def run(self, *, q: Values = None, v: Values = None, **settings: Any) -> Run:
        """Makes a run as `Scene.run`, from the start `q`, `v` where these are given."""
        if q is None and v is None:
            return super().run(**settings)
        return Scene.run(self.started(q, v), **settings)


def _rows(given: Mapping[str, Any] | Iterable[Any]) -> tuple[Any, list[Any]]:
    """Constraints as a scene has them, by their names if they have names, and what they are made of."""
    if isinstance(given, Mapping):
        return {key: _vanishing(row) for key, row in given.items()}, list(given.values())
    made = list(given)
    return [_vanishing(row) for row in made], made


def _vanishing(row: Any) -> str:
    """The text of what vanishes; of an equation of SymPy its left side less its right one."""
    return text(row.lhs - row.rhs if type(row).__name__ == "Equality" else row)


def _named(coordinates: list[str], values: Values, suffix: str) -> dict[str, float]:
    """Numbers of the start by the key that each has in a scene."""
    if values is None:
        return {}
    if isinstance(values, Mapping):
        given = {name(key): float(value) for key, value in values.items()}
        unknown = [key for key in given if key not in coordinates]
        if unknown:
            raise RequestError(f"no coordinate {unknown[0]!r}; the coordinates are {', '.join(coordinates)}")
        return {f"{key}{suffix}": value for key, value in given.items()}
    listed = [float(value) for value in values]
    if len(listed) != len(coordinates):
        raise RequestError(f"{len(listed)} numbers for {len(coordinates)} coordinates")
    return {f"{key}{suffix}": value for key, value in zip(coordinates, listed, strict=True)}

