"""Other revisions of a repository, checked out for a while."""

import shutil
import subprocess

import pytest

from tests.benchmarks import checkouts
from tests.benchmarks.checkouts import NoCheckoutError, checkout_of


def git(folder, *arguments) -> str:
    identity = ("-c", "user.name=Nobody", "-c", "user.email=nobody@example.org")
    command = ["git", "-C", str(folder), *identity, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """Two commits, of which the older has another text."""
    if shutil.which("git") is None:
        pytest.skip("git is not installed")
    folder = tmp_path / "repository"
    folder.mkdir()
    git(folder, "init", "--quiet")
    for text in ("older", "newer"):
        (folder / "file.txt").write_text(text)
        git(folder, "add", ".")
        git(folder, "commit", "--quiet", "-m", text)
    monkeypatch.setattr(checkouts, "HERE", folder)
    return folder


def test_a_folder_is_taken_as_it_is(tmp_path):
    with checkout_of(str(tmp_path)) as checkout:
        assert checkout == tmp_path.resolve()
    assert tmp_path.is_dir()


def test_a_revision_is_there_until_the_context_ends(repository):
    with checkout_of("HEAD~1") as checkout:
        assert (checkout / "file.txt").read_text() == "older"
        (checkout / "left.txt").write_text("by a run")
    assert not checkout.exists()
    assert len(git(repository, "worktree", "list").splitlines()) == 1
    assert (repository / "file.txt").read_text() == "newer"


def test_it_goes_when_what_runs_in_it_fails(repository):
    with pytest.raises(ZeroDivisionError), checkout_of("HEAD") as checkout:
        raise ZeroDivisionError
    assert not checkout.exists()


def test_a_revision_that_is_not_there_is_named(repository):
    with pytest.raises(NoCheckoutError, match="0123456"), checkout_of("0123456"):
        pass


def test_without_git_there_is_none(repository, monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(NoCheckoutError, match="git"), checkout_of("HEAD"):
        pass
