"""Plans a part, shows a layer, and writes its program: ``python ten_lines.py``."""

import beadwright

part = beadwright.Part.example("propeller")
profile = beadwright.Profile("cmt-al2319-kuka").set(layers__height=2.0)
plan = beadwright.plan(part, profile, strategy="loop")
first = plan.layers[0].passes[0]
print(plan, f"{plan.metrics.total_time_s / 60:.1f} min, {first.points.shape[0]} points in the first pass")
for warning in plan.warnings:
    print(warning)
print(beadwright.simulate(plan))
print(f"{len(plan.save('propeller-out'))} files in propeller-out")
