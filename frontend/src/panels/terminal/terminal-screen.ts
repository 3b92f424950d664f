import { FitAddon } from "@xterm/addon-fit";
import { Unicode11Addon } from "@xterm/addon-unicode11";
import { Terminal } from "@xterm/xterm";
import { h } from "../../dom";
import type { TerminalOutput } from "../../protocol";
import type { TerminalSize, TerminalsState } from "../../state/terminals";
import type { Theme } from "../../state/theme";
import { strings } from "../../strings";
import { copyText } from "../../widgets/copy-text";
import { terminalColors } from "./terminal-colors";
import { TERMINAL_KEYS } from "./terminal-keys";

/** Messages with output that are processed before they are acknowledged; the server waits at a few times as many. */
const ACKNOWLEDGED_TOGETHER = 4;
const SCROLLBACK_LINES = 5000;
/** Contrast of text, as WCAG AA requires it, whatever colors a program combines. */
const CONTRAST = 4.5;
/** Clears the screen and all modes, in the order of the output. */
const FULL_RESET = "\x1bc";

/** One terminal on the page: its text, its keys, and the acknowledgment of its output. */
export class TerminalScreen {
  readonly element = h("div", { class: "terminal-screen" });
  readonly xterm: Terminal;
  private readonly fitAddon = new FitAddon();
  private isOpened = false;
  /** The number of replays that are being processed; queries in them were answered before. */
  private replays = 0;
  private acknowledged = 0;

  /**
   * @param onLeave - called when the user leaves the terminal with the keyboard.
   * @param onEnter - called when the user presses Enter; returns whether the key is not for the shell.
   */
  constructor(
    private readonly id: number,
    private readonly state: TerminalsState,
    theme: Theme,
    screenReader: boolean,
    private readonly onLeave: () => void,
    private readonly onEnter: () => boolean,
  ) {
    this.xterm = new Terminal({
      allowProposedApi: true, // of the widths of characters
      fontFamily: getComputedStyle(document.documentElement).getPropertyValue("--mono"),
      fontSize: 13,
      minimumContrastRatio: CONTRAST,
      screenReaderMode: screenReader,
      scrollback: SCROLLBACK_LINES,
      theme: terminalColors(theme),
    });
    this.xterm.loadAddon(this.fitAddon);
    this.xterm.loadAddon(new Unicode11Addon());
    this.xterm.unicode.activeVersion = "11";
    this.xterm.attachCustomKeyEventHandler((event) => this.isForShell(event));
    this.xterm.onData((text) => this.write(text, false));
    this.xterm.onBinary((text) => this.write(text, true));
    this.xterm.onResize(({ cols, rows }) => state.resize(id, { columns: cols, rows }));
    // The keys of the page do not work here, except for full screen.
    this.element.addEventListener("keydown", (event) => event.key !== "F11" && event.stopPropagation());
  }

  get size(): TerminalSize {
    return { columns: this.xterm.cols, rows: this.xterm.rows };
  }

  /** Fits the terminal into its element, which must be on the page. */
  fit(): void {
    if (this.element.offsetWidth === 0) return;
    if (!this.isOpened) {
      this.isOpened = true;
      this.xterm.open(this.element);
      this.xterm.textarea?.setAttribute("aria-label", strings.terminal.input(this.id));
    }
    this.fitAddon.fit();
  }

  receive({ number, text, is_replay: isReplay }: TerminalOutput): void {
    if (isReplay) this.replays += 1;
    this.xterm.write(isReplay ? FULL_RESET + text : text, () => {
      if (isReplay) this.replays -= 1;
      if (!isReplay && number - this.acknowledged < ACKNOWLEDGED_TOGETHER) return;
      this.acknowledged = number;
      this.state.acknowledge(this.id, number);
    });
  }

  setTheme(theme: Theme): void {
    this.xterm.options.theme = terminalColors(theme);
  }

  setScreenReader(isOn: boolean): void {
    this.xterm.options.screenReaderMode = isOn;
  }

  /** Copies the selected text, and returns whether there was any. */
  async copy(): Promise<boolean> {
    const text = this.xterm.getSelection();
    return text !== "" && copyText(text);
  }

  /** Returns the text of the screen and of the lines above it, for tests. */
  text(): string {
    const { active } = this.xterm.buffer;
    return Array.from({ length: active.length }, (_, row) => active.getLine(row)?.translateToString(true) ?? "").join("\n").trimEnd();
  }

  dispose(): void {
    this.xterm.dispose();
    this.element.remove();
  }

  private write(text: string, isBinary: boolean): void {
    if (this.replays > 0 || (text === "\r" && this.onEnter())) return;
    this.state.write(this.id, text, isBinary);
  }

  /** Handles the keys of the page, and returns whether the terminal handles the event. */
  private isForShell(event: KeyboardEvent): boolean {
    if (event.key === "F11") return false;
    if (!event.ctrlKey || !event.shiftKey || event.altKey || event.metaKey) return true;
    switch (event.code) {
      case TERMINAL_KEYS.copy:
        event.preventDefault(); // browsers would open their tools
        if (event.type === "keydown") void this.copy();
        return false;
      case TERMINAL_KEYS.paste:
        return false; // the browser pastes
      case TERMINAL_KEYS.leave:
        event.preventDefault();
        if (event.type === "keydown") this.onLeave();
        return false;
      default:
        return true;
    }
  }
}
