/** Returns `#303030` in RViz's notation: `48; 48; 48`. */
export function formatColor(hex: string): string {
  const match = /^#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})$/i.exec(hex);
  if (!match) return hex;
  return match
    .slice(1)
    .map((part) => parseInt(part, 16))
    .join("; ");
}

/** Parses `48; 48; 48`, `48, 48, 48`, `48 48 48` or `#303030`; returns null if the text is not a color. */
export function parseColor(text: string): string | null {
  const color = text.trim();
  if (/^#[0-9a-f]{6}$/i.test(color)) return color.toLowerCase();
  const parts = color.split(/[\s;,]+/).map(Number);
  if (parts.length !== 3 || parts.some((part) => !Number.isInteger(part) || part < 0 || part > 255)) return null;
  return `#${parts.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}
