"""Texts of scenes from SymPy expressions."""

from __future__ import annotations

from typing import Any

from ._noslip import RequestError


def text(expression: Any) -> str:
    """The text of an expression: a string as it stands, a number with all of its digits, a SymPy expression by its tree.

    A function of the time, as `dynamicsymbols("x")` makes, is the coordinate of its name, its derivative the rate `x'`, and
    every symbol a parameter, or the time `t`.
    """
    if isinstance(expression, str):
        return expression
    if isinstance(expression, (int, float)):
        return repr(expression)
    import sympy as sp

    checked = sp.sympify(expression)
    if isinstance(checked, sp.MatrixBase) and checked.shape == (1, 1):
        checked = checked[0]
    _check(checked)
    return str(_printer().doprint(checked))


def name(symbol: Any) -> str:
    """The name of a coordinate: a string, a symbol, a function of the time, or the rate of one."""
    if isinstance(symbol, str):
        return symbol
    import sympy as sp

    if isinstance(symbol, sp.Derivative):
        symbol = symbol.args[0]
    return str(symbol.func.__name__ if symbol.args else symbol)


KNOWN = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "sign"}
RENAMED = {"Abs": "abs", "Max": "max", "Min": "min"}


def _check(expression: Any) -> None:
    """Refuses what has no text in a scene."""
    import sympy as sp
    from sympy.core.function import AppliedUndef

    if isinstance(expression, AppliedUndef):
        return
    if isinstance(expression, sp.Derivative):
        function, *variables = expression.args
        if isinstance(function, AppliedUndef) and len(variables) == 1 and variables[0][1] == 1:
            return
        raise RequestError(f"{expression}: accepted are first derivatives of coordinates by the time")
    if isinstance(expression, (sp.Function, sp.Max, sp.Min, sp.Abs)):
        called = expression.func.__name__
        if called not in KNOWN | set(RENAMED):
            raise RequestError(f"{expression}: no function `{called}` is known in a scene")
    elif not isinstance(expression, (sp.Symbol, sp.Number, sp.Add, sp.Mul, sp.Pow, type(sp.pi), type(sp.E))):
        raise RequestError(f"{expression}: a scene has no text for {type(expression).__name__}")
    elif isinstance(expression, sp.Number) and not expression.is_finite:
        raise RequestError(f"{expression} is not a finite number")
    for argument in expression.args:
        _check(argument)


def _printer() -> Any:
    from sympy.core.function import AppliedUndef
    from sympy.printing.str import StrPrinter

    class Printer(StrPrinter):  # type: ignore[misc]
        """SymPy's own text, with the names that scenes have."""

        def _print_Derivative(self, expression: Any) -> str:
            return f"{name(expression.args[0])}'"

        def _print_Function(self, expression: Any) -> str:
            if isinstance(expression, AppliedUndef):
                return name(expression)
            called = expression.func.__name__
            arguments = ", ".join(self.doprint(argument) for argument in expression.args)
            return f"{RENAMED.get(called, called)}({arguments})"

        _print_Abs = _print_Max = _print_Min = _print_Function

        def _print_Float(self, expression: Any) -> str:
            return repr(float(expression))

        def _print_Exp1(self, expression: Any) -> str:
            return "exp(1)"

    return Printer()
