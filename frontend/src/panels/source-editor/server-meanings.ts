import type { Text } from "@codemirror/state";
import { offsetOf } from "./server-places";

const FIELDS_PER_TOKEN = 5;

/** A color whose parts are between 0 and 1. */
export interface Color {
  readonly red: number;
  readonly green: number;
  readonly blue: number;
  readonly alpha: number;
}
/** The names of types and modifiers, by which tokens refer to them. */
export interface Legend {
  readonly tokenTypes: readonly string[];
  readonly tokenModifiers: readonly string[];
}

interface TokenRange {
  readonly from: number;
  readonly to: number;
  readonly names: readonly string[];
}

/** Returns the ranges of semantic tokens, with their types and modifiers, from the relative numbers of the protocol. */
export function decodeTokens(doc: Text, data: readonly number[], { tokenTypes, tokenModifiers }: Legend): TokenRange[] {
  const ranges: TokenRange[] = [];
  let [line, character] = [0, 0];
  for (let index = 0; index + FIELDS_PER_TOKEN <= data.length; index += FIELDS_PER_TOKEN) {
    const [lineOffset = 0, characterOffset = 0, length = 0, type = 0, modifiers = 0] = data.slice(index, index + FIELDS_PER_TOKEN);
    character = lineOffset === 0 ? character + characterOffset : characterOffset;
    line += lineOffset;
    const names = [tokenTypes[type] ?? "", ...tokenModifiers.filter((_, bit) => (modifiers >> bit) & 1)];
    const start = offsetOf(doc, { line, character });
    const end = offsetOf(doc, { line, character: character + length });
    if (end > start) ranges.push({ from: start, to: end, names });
  }
  return ranges;
}

/** Returns a color as `#rrggbb`, without its alpha. */
export function toHex({ red, green, blue }: Color): string {
  return `#${[red, green, blue].map((channel) => Math.round(Math.min(Math.max(channel, 0), 1) * 255).toString(16).padStart(2, "0")).join("")}`;
}

/** Returns the color of `#rrggbb`, opaque. */
export function parseHex(hex: string): Color {
  const [red = 0, green = 0, blue = 0] = [1, 3, 5].map((start) => Math.round((parseInt(hex.slice(start, start + 2), 16) / 255) * 1000) / 1000);
  return { red, green, blue, alpha: 1 };
}
