"""What calls of a compiled class look like, for help() and editors: the compiler keeps that of functions only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from paneldraw._compiled import PACKAGE

if TYPE_CHECKING:
    import ast
    import inspect


class SignatureOfInit:
    """A class's ``__signature__``, read from the source of its ``__init__`` when somebody asks."""

    def __get__(self, instance: object, owner: type) -> inspect.Signature:
        import ast

        made_by = next(kind for kind in owner.__mro__ if "__init__" in vars(kind))
        if "__signature__" not in vars(made_by):
            raise AttributeError("__signature__")
        source = PACKAGE.joinpath(*made_by.__module__.split(".")[1:]).with_suffix(".py")
        (made,) = (
            node
            for node in ast.parse(source.read_text(encoding="utf-8")).body
            if isinstance(node, ast.ClassDef) and node.name == made_by.__name__
        )
        (init,) = (part for part in made.body if isinstance(part, ast.FunctionDef) and part.name == "__init__")
        return _signature(init.args)


def _signature(arguments: ast.arguments) -> inspect.Signature:
    """What a function takes, but for `self`."""
    import ast
    from inspect import Parameter, Signature

    plain = len(arguments.args) - len(arguments.defaults)
    listed = [
        *((argument, Parameter.POSITIONAL_OR_KEYWORD) for argument in arguments.args),
        *((argument, Parameter.KEYWORD_ONLY) for argument in arguments.kwonlyargs),
    ]
    defaults = [*[None] * plain, *arguments.defaults, *arguments.kw_defaults]
    return Signature(
        [
            Parameter(
                argument.arg,
                kind,
                default=ast.literal_eval(default) if default else Parameter.empty,
                annotation=ast.unparse(argument.annotation) if argument.annotation else Parameter.empty,
            )
            for (argument, kind), default in list(zip(listed, defaults, strict=True))[1:]
        ]
    )
