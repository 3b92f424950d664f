/** Returns `#303030` in RViz's notation: `48; 48; 48`. */
export function formatColor(hex: string): string {
  const match = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(hex);
  if (!match) return hex;
  return match
    .slice(1)
    .map((channel) => parseInt(channel, 16))
    .join("; ");
}

/** Parses `48; 48; 48`, `48, 48, 48`, `48 48 48` or `#303030`; returns null if the text is not a color. */
export function parseColor(text: string): string | null {
  const color = text.trim();
  if (/^#[0-9a-f]{6}$/i.test(color)) return color.toLowerCase();
  const channels = color.split(/[\s;,]+/).map(Number);
  if (channels.length !== 3 || channels.some((channel) => !Number.isInteger(channel) || channel < 0 || channel > 255)) return null;
  return `#${channels.map((channel) => channel.toString(16).padStart(2, "0")).join("")}`;
}
