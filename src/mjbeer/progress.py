"""How far a long command has come."""

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn


def counted(console: Console) -> Progress:
    """A bar with what is done, how many pieces of it, and since when; nothing where the console is no terminal."""
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}/{task.total}")
    return Progress(*columns, TimeElapsedColumn(), console=console, disable=not console.is_terminal)
