"""A study of two parts over two keys on the processes of this machine, with its table and Pareto figure."""

import beadwright


def main() -> None:
    """Makes twelve plans; a second run makes none."""
    done = beadwright.study(
        [beadwright.Part.example("cross"), beadwright.Part.example("star")],
        {"fill.strategy": ["contour", "zigzag", "loop"], "layers.height": [1.8, 2.0]},
        measures=["total_time_s", "arc_starts", "deposit.void_percent"],
        folder="study-out",
    )
    print(done)
    for row in done.pareto("total_time_s", "deposit.void_percent"):
        print(row["part"], row["fill.strategy"], row["layers.height"], row["total_time_s"], row["deposit.void_percent"])


if __name__ == "__main__":
    main()
