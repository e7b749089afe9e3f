// Ramps of colours, 0 to 255 for each channel. INKS is the palette (colours.rs).

const RAMP = INKS.rising, EMBER = INKS.warmth;

const mix = (c, to, part) => c.map((v, i) => v + (to[i] - v) * part);

function rampAt(part, ramp = RAMP) {
  const at = Math.min(Math.max(part, 0), 1) * (ramp.length - 1), i = Math.min(Math.floor(at), ramp.length - 2);
  return mix(ramp[i], ramp[i + 1], at - i);
}
