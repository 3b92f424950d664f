import { FitAddon } from "@xterm/addon-fit";
import { Unicode11Addon } from "@xterm/addon-unicode11";
import { Terminal } from "@xterm/xterm";
import { h } from "../../dom";
import type { TerminalOutput } from "../../protocol";
import type { TerminalSize, TerminalsState } from "../../state/terminals";
import type { Theme } from "../../state/theme";
import { strings } from "../../strings";
import { copyText } from "../../widgets/copy-text";
import { readTerminalColors } from "./terminal-colors";
import { TERMINAL_KEYS } from "./terminal-keys";

/** The number of messages with output per acknowledgment; the server waits after a few times as many. */
const MESSAGES_PER_ACKNOWLEDGMENT = 4;
const SCROLLBACK_LINES = 5000;
/** The contrast of text that WCAG AA requires, for all combinations of colors. */
const MIN_CONTRAST = 4.5;
/** Clears the screen and all modes, in the order of the output. */
const FULL_RESET = "\x1bc";

/** One terminal on the page: its text, its keys, and the acknowledgment of its output. */
export class TerminalScreen {
  readonly element = h("div", { class: "terminal-screen" });
  readonly xterm: Terminal;
  private readonly fitAddon = new FitAddon();
  private isOpened = false;
  /** The number of replays that are being processed; their queries to the terminal were answered earlier. */
  private replayCount = 0;
  private acknowledgedNumber = 0;

  /**
   * @param onLeave - called when the user leaves the terminal with the keyboard.
   * @param onEnter - called when the user presses Enter; returns whether the key is not for the shell.
   */
  constructor(
    private readonly id: number,
    private readonly state: TerminalsState,
    theme: Theme,
    usesScreenReader: boolean,
    private readonly onLeave: () => void,
    private readonly onEnter: () => boolean,
  ) {
    this.xterm = new Terminal({
      allowProposedApi: true, // for the widths of characters
      fontFamily: getComputedStyle(document.documentElement).getPropertyValue("--mono"),
      fontSize: 13,
      minimumContrastRatio: MIN_CONTRAST,
      screenReaderMode: usesScreenReader,
      scrollback: SCROLLBACK_LINES,
      theme: readTerminalColors(theme),
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
    if (isReplay) this.replayCount += 1;
    this.xterm.write(isReplay ? FULL_RESET + text : text, () => {
      if (isReplay) this.replayCount -= 1;
      if (!isReplay && number - this.acknowledgedNumber < MESSAGES_PER_ACKNOWLEDGMENT) return;
      this.acknowledgedNumber = number;
      this.state.acknowledge(this.id, number);
    });
  }

  setTheme(theme: Theme): void {
    this.xterm.options.theme = readTerminalColors(theme);
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
  readText(): string {
    const { active } = this.xterm.buffer;
    return Array.from({ length: active.length }, (_, row) => active.getLine(row)?.translateToString(true) ?? "").join("\n").trimEnd();
  }

  dispose(): void {
    this.xterm.dispose();
    this.element.remove();
  }

  private write(text: string, isBinary: boolean): void {
    if (this.replayCount > 0 || (text === "\r" && this.onEnter())) return;
    this.state.write(this.id, text, isBinary);
  }

  /** Handles the keys of the page, and returns whether the terminal handles the event. */
  private isForShell(event: KeyboardEvent): boolean {
    if (event.key === "F11") return false;
    if (!event.ctrlKey || !event.shiftKey || event.altKey || event.metaKey) return true;
    switch (event.code) {
      case TERMINAL_KEYS.copy:
        event.preventDefault(); // the browser would open its developer tools
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
