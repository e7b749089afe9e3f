// Ramps of colours, 0 to 255 for each channel.

// Violet to yellow, of rising lightness (after matplotlib's "viridis", less its ends, which would vanish on the page).
const RAMP = [[71, 45, 123], [49, 104, 142], [32, 146, 140], [94, 201, 98], [223, 227, 24]];
// Dark violet to yellow, of rising lightness, so that it reads in grey too (after matplotlib's "inferno").
const EMBER = [[40, 11, 84], [120, 28, 109], [188, 55, 84], [237, 105, 37], [251, 180, 26]];

const mix = (c, to, part) => c.map((v, i) => v + (to[i] - v) * part);

function rampAt(part, ramp = RAMP) {
  const at = Math.min(Math.max(part, 0), 1) * (ramp.length - 1), i = Math.min(Math.floor(at), ramp.length - 2);
  return mix(ramp[i], ramp[i + 1], at - i);
}
