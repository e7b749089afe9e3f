"""Searches for the layer height and overlap that build a part fastest with little void, with Optuna: ``python optimise.py``."""

import optuna

import beadwright

PART = beadwright.Part.example("cross")
BASE = beadwright.Profile("cmt-al2319-kuka").set(fill__overlap="free", fill__stepover=5.4)
#: The most void that is accepted, %.
MOST_VOID = 1.0


def measured(trial: optuna.Trial) -> tuple[float, float]:
    """Time of the build, min, and void, %."""
    profile = BASE.set(
        {
            "fill.strategy": trial.suggest_categorical("strategy", ["loop", "contour", "zigzag"]),
            "fill.stepover": trial.suggest_float("stepover", 4.5, 6.5),
        }
    )
    try:
        plan = beadwright.plan(PART, profile)
    except beadwright.BeadwrightError as error:
        # A part that cannot be built is just a failed trial.
        raise optuna.TrialPruned(str(error)) from error
    return plan.metrics.total_time_s / 60, beadwright.simulate(plan).row["void %"]


def main() -> None:
    """Thirty trials; the same every time."""
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    study = optuna.create_study(directions=["minimize", "minimize"], sampler=optuna.samplers.TPESampler(seed=1))
    study.optimize(measured, n_trials=30)
    for trial in sorted(study.best_trials, key=lambda trial: trial.values):
        minutes, void = trial.values
        mark = "  <- taken" if void <= MOST_VOID else ""
        print(f"{minutes:6.1f} min  {void:5.2f} % void  {trial.params}{mark}")


if __name__ == "__main__":
    main()
