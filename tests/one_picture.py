"""Requests of one picture, by the names of all that can be said, whoever it is said of."""

from dataclasses import fields, replace
from typing import Any

from fitter.request import Choices, FitRequest, Person, View


def one_picture(**said: Any) -> FitRequest:
    """A request of one picture: what is said is of the person, of the picture or a choice."""
    _check(said)
    return FitRequest(
        person=Person(**_of(Person, said)),
        views=(View(**_of(View, said)),),
        choices=Choices(**_of(Choices, said)),
    )


def changed(request: FitRequest, **said: Any) -> FitRequest:
    """The same with other values; what is said of a picture holds for every one."""
    _check(said)
    return FitRequest(
        person=replace(request.person, **_of(Person, said)),
        views=tuple(replace(view, **_of(View, said)) for view in request.views),
        choices=replace(request.choices, **_of(Choices, said)),
    )


def together(*requests: FitRequest) -> FitRequest:
    """One request of the pictures of several, with the person and choices of the first."""
    return replace(requests[0], views=tuple(view for each in requests for view in each.views))


def _check(said: dict[str, Any]) -> None:
    known = {field.name for kind in (Person, View, Choices) for field in fields(kind)}
    assert said.keys() <= known, said.keys() - known


def _of(kind: type, said: dict[str, Any]) -> dict[str, Any]:
    names = {field.name for field in fields(kind)}
    return {name: value for name, value in said.items() if name in names}
