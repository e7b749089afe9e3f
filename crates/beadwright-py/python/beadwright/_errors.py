"""What goes wrong, for people."""


class BeadwrightError(Exception):
    """Why something cannot be done.

    ``place`` says where (a path, a line, a key), ``remedy`` what helps; either may be ``None``.
    """

    def __init__(self, message: str, place: str | None = None, remedy: str | None = None) -> None:
        super().__init__(message, place, remedy)
        self.message = message
        self.place = place
        self.remedy = remedy

    def __str__(self) -> str:
        return self.message if self.remedy is None else f"{self.message} {self.remedy}"
