import "@xterm/xterm/css/xterm.css";
import "../../styles/terminal.css";
import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TerminalItem } from "../../protocol";
import type { TerminalSize, TerminalsState } from "../../state/terminals";
import type { ThemeState } from "../../state/theme";
import type { TextStorage } from "../../storage";
import { strings } from "../../strings";
import { TerminalScreen } from "./terminal-screen";

const READER_KEY = "linkwright.terminal-reader";
const ENABLED = "1";
/** The size of a terminal until its place on the page is known. */
const INITIAL_SIZE: TerminalSize = { columns: 80, rows: 24 };
/** Browsers slow down hidden pages: after this time, the server no longer waits for the page to read the output. */
const HIDE_DELAY_MS = 60_000;

/** The terminals of the page: a tab for each, and the screen of the chosen one. */
export class TerminalDeck {
  readonly element: HTMLElement;
  private readonly tabs = h("div", { class: "segmented terminal-tabs", role: "tablist", aria: { label: strings.terminal.tabs } });
  private readonly screenBox = h("div", { class: "terminal-place" });
  private readonly notice = h("div", { class: "terminal-notice", role: "status" });
  private readonly noticeText = h("span");
  private readonly noticeButton: HTMLButtonElement;
  private readonly closeButton: HTMLButtonElement;
  private readonly readerButton: HTMLButtonElement;
  private readonly screens = new Map<number, TerminalScreen>();
  private currentId: number | null = null;
  private isVisible = false;
  private usesScreenReader: boolean;
  /** The terminal that was requested, or 0 for a new one, until the server has answered. */
  private requestedId: number | null = null;
  private lostInputId: number | null = null;
  private hideTimer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly state: TerminalsState,
    private readonly theme: ThemeState,
    private readonly storage: TextStorage,
  ) {
    const texts = strings.terminal;
    this.usesScreenReader = storage.getItem(READER_KEY) === ENABLED;
    this.noticeButton = createButton(texts.restart, () => this.runNoticeAction(), "tool framed", texts.restart);
    this.notice.append(this.noticeText, this.noticeButton);
    this.closeButton = createButton(texts.closeHint, () => this.close(), "tool", createIcon("close"), texts.close);
    this.readerButton = createButton(texts.readerHint, () => this.toggleReader(), "tool", createIcon("speech"));
    const copyButton = createButton(texts.copyHint, () => void this.screen?.copy(), "tool", createIcon("copy"));
    const toolbar = h(
      "div",
      { class: "toolbar" },
      this.tabs,
      createButton(texts.newHint, () => this.openNew(), "tool", createIcon("plus"), texts.new),
      h("span", { class: "spacer" }),
      h("span", { class: "note terminal-keys" }, texts.keys),
      copyButton,
      this.readerButton,
      this.closeButton,
    );
    this.element = h("div", { class: "terminal-deck" }, toolbar, this.screenBox, this.notice);
    this.tabs.addEventListener("keydown", (event) => this.onTabKey(event));
    new ResizeObserver(() => this.screen?.fit()).observe(this.screenBox);
    state.changed.on(() => this.update());
    state.connectionChanged.on(() => this.showNotice());
    state.connected.on((isSameRun) => {
      this.requestedId = null;
      if (!isSameRun) this.disposeScreens(() => true);
    });
    state.output.on((output) => this.ensureScreen(output.terminal).receive(output));
    state.inputLost.on((id) => {
      this.lostInputId = id;
      this.showNotice();
    });
    theme.changed.on((newTheme) => {
      for (const screen of this.screens.values()) screen.setTheme(newTheme);
    });
    document.addEventListener("visibilitychange", () => this.followPage());
    this.updateReaderButton();
    this.update();
  }

  setVisible(isVisible: boolean): void {
    this.isVisible = isVisible;
    this.update();
  }

  inspect(): object {
    const { screen } = this;
    return {
      current: this.currentId,
      terminals: this.state.items.map((item) => ({ ...item })),
      text: screen?.readText() ?? "",
      size: screen?.size ?? null,
      scrollback: screen?.xterm.buffer.active.length ?? 0,
      notice: this.notice.hidden ? "" : this.noticeText.textContent,
      focused: this.screenBox.contains(document.activeElement),
    };
  }

  private get currentItem(): TerminalItem | undefined {
    return this.currentId === null ? undefined : this.state.find(this.currentId);
  }

  private get screen(): TerminalScreen | undefined {
    return this.currentId === null ? undefined : this.screens.get(this.currentId);
  }

  private get size(): TerminalSize {
    return this.screen?.size ?? INITIAL_SIZE;
  }

  private ensureScreen(id: number): TerminalScreen {
    const existing = this.screens.get(id);
    if (existing) return existing;
    const screen = new TerminalScreen(id, this.state, this.theme.theme, this.usesScreenReader, () => this.findTab(id)?.focus(), () => this.restartEnded());
    this.screens.set(id, screen);
    screen.element.hidden = true;
    this.screenBox.append(screen.element);
    return screen;
  }

  /** Adopts the server's list: removes closed terminals, chooses one, and requests it if no page shows it. */
  private update(): void {
    const { items } = this.state;
    this.disposeScreens((id) => this.state.find(id) === undefined);
    if (this.requestedId !== null && this.state.unavailableReason !== "") this.requestedId = null;
    if (this.requestedId === 0) {
      const openedItem = items.findLast(({ id, shown }) => shown === "here" && id !== this.currentId);
      if (openedItem) this.choose(openedItem.id);
    } else if (this.requestedId !== null && this.state.find(this.requestedId)?.shown === "here") this.requestedId = null;
    if (this.currentItem === undefined) this.currentId = (items.find(({ shown }) => shown !== "elsewhere") ?? items[0])?.id ?? null;
    this.showTabs();
    this.showNotice();
    if (!this.isVisible || document.hidden) return;
    if (this.currentId === null && this.state.unavailableReason === "") this.openNew();
    this.showScreen();
    if (this.currentItem?.shown === "nowhere" && this.requestedId !== this.currentId) this.request();
  }

  private disposeScreens(isObsolete: (id: number) => boolean): void {
    for (const [id, screen] of this.screens) {
      if (!isObsolete(id)) continue;
      screen.dispose();
      this.screens.delete(id);
    }
  }

  private choose(id: number): void {
    this.requestedId = null;
    this.currentId = id;
    this.update();
    this.screen?.xterm.focus();
  }

  private showScreen(): void {
    const { currentId } = this;
    if (currentId === null) return;
    this.ensureScreen(currentId);
    for (const [id, screen] of this.screens) screen.element.hidden = id !== currentId || this.currentItem?.shown === "elsewhere";
    this.screen?.fit();
  }

  private request(): void {
    if (this.currentId === null) return;
    this.requestedId = this.currentId;
    this.state.show(this.currentId, this.size);
  }

  private openNew(): void {
    if (this.requestedId === 0) return;
    this.requestedId = 0;
    this.state.open(this.size);
  }

  private close(): void {
    if (this.currentId === null) return;
    const ids = this.state.items.map(({ id }) => id);
    const index = ids.indexOf(this.currentId);
    const closedId = this.currentId;
    this.currentId = ids[index + 1] ?? ids[index - 1] ?? null;
    this.state.close(closedId);
    this.update();
  }

  /** Restarts the shell if it has ended, and returns whether it had ended. */
  private restartEnded(): boolean {
    if (this.currentId === null || (this.currentItem?.status ?? null) === null) return false;
    this.state.restart(this.currentId, this.size);
    this.screen?.xterm.focus();
    return true;
  }

  private showTabs(): void {
    const hasFocus = this.tabs.contains(document.activeElement);
    const tabs = this.state.items.map(({ id, status }) => {
      const isCurrent = id === this.currentId;
      const name = strings.terminal.name(id);
      const tab = createButton(name, () => this.choose(id), isCurrent ? "on" : "", status === null ? name : strings.terminal.ended(name));
      tab.setAttribute("role", "tab");
      tab.setAttribute("aria-selected", String(isCurrent));
      tab.tabIndex = isCurrent ? 0 : -1;
      tab.dataset["terminal"] = String(id);
      return tab;
    });
    this.tabs.replaceChildren(...tabs);
    this.tabs.hidden = tabs.length === 0;
    this.closeButton.disabled = this.currentId === null;
    if (hasFocus && this.currentId !== null) this.findTab(this.currentId)?.focus();
  }

  private findTab(id: number): HTMLElement | null {
    return this.tabs.querySelector(`[data-terminal="${id}"]`);
  }

  private onTabKey(event: KeyboardEvent): void {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    const ids = this.state.items.map(({ id }) => id);
    const nextId = ids[(ids.indexOf(this.currentId ?? -1) + step + ids.length) % ids.length];
    if (step === 0 || nextId === undefined) return;
    event.preventDefault();
    this.currentId = nextId;
    this.update();
    this.findTab(nextId)?.focus();
  }

  /** Shows why the terminal cannot be used now, and what the user can do. */
  private showNotice(): void {
    const texts = strings.terminal;
    const { currentItem } = this;
    let [text, action] = [this.state.isConnected ? this.state.unavailableReason : texts.disconnected, ""];
    if (text === "" && currentItem?.shown === "elsewhere") [text, action] = [texts.elsewhere, texts.showHere];
    else if (text === "" && currentItem && currentItem.status !== null) [text, action] = [texts.endedWith(currentItem.status), texts.restart];
    else if (text === "" && this.lostInputId === this.currentId && currentItem) text = texts.inputLost;
    this.noticeText.textContent = text;
    this.noticeButton.textContent = action;
    this.noticeButton.title = action;
    this.noticeButton.hidden = action === "";
    this.notice.hidden = text === "";
  }

  private runNoticeAction(): void {
    if (this.currentItem?.shown === "elsewhere") this.request();
    else this.restartEnded();
    this.screen?.xterm.focus();
  }

  private toggleReader(): void {
    this.usesScreenReader = !this.usesScreenReader;
    this.storage.setItem(READER_KEY, this.usesScreenReader ? ENABLED : "");
    for (const screen of this.screens.values()) screen.setScreenReader(this.usesScreenReader);
    this.updateReaderButton();
  }

  private updateReaderButton(): void {
    this.readerButton.classList.toggle("on", this.usesScreenReader);
    this.readerButton.setAttribute("aria-pressed", String(this.usesScreenReader));
  }

  /**
   * Leaves the terminals some time after the page was hidden, and shows the chosen one again when the page is shown.
   */
  private followPage(): void {
    clearTimeout(this.hideTimer);
    if (!document.hidden) this.update();
    else this.hideTimer = setTimeout(() => this.hideAll(), HIDE_DELAY_MS);
  }

  private hideAll(): void {
    for (const { id, shown } of this.state.items) if (shown === "here") this.state.hide(id);
  }
}
