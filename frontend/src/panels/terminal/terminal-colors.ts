import type { ITheme } from "@xterm/xterm";
import type { Theme } from "../../state/theme";

/** The named colors of terminals, which the page's style sheet does not contain. */
const ANSI_COLORS: Readonly<Record<Theme, ITheme>> = {
  dark: {
    black: "#2a2f37",
    red: "#ff6f64",
    green: "#58c283",
    yellow: "#e0b040",
    blue: "#58a6ff",
    magenta: "#d08bea",
    cyan: "#4fc4cf",
    white: "#cdd4dd",
    brightBlack: "#8a94a3",
    brightRed: "#ff938b",
    brightGreen: "#7fd9a2",
    brightYellow: "#f2cd73",
    brightBlue: "#8cc2ff",
    brightMagenta: "#e2b0f5",
    brightCyan: "#84dde5",
    brightWhite: "#ffffff",
  },
  light: {
    black: "#1b232d",
    red: "#b8282b",
    green: "#1a6f3c",
    yellow: "#7a5100",
    blue: "#0b60c0",
    magenta: "#8a2da5",
    cyan: "#0b6a75",
    white: "#5a6675",
    brightBlack: "#4a5563",
    brightRed: "#c93a34",
    brightGreen: "#237f48",
    brightYellow: "#8f6100",
    brightBlue: "#1f73d4",
    brightMagenta: "#9c44b6",
    brightCyan: "#147c88",
    brightWhite: "#2d3743",
  },
};

/** Returns the colors of terminals for a theme of the page. */
export function readTerminalColors(theme: Theme): ITheme {
  const styles = getComputedStyle(document.documentElement);
  const readColor = (name: string): string => styles.getPropertyValue(name).trim();
  return {
    ...ANSI_COLORS[theme],
    background: readColor("--bg-field"),
    foreground: readColor("--text"),
    cursor: readColor("--text"),
    cursorAccent: readColor("--bg-field"),
    selectionBackground: readColor("--selection"),
  };
}
