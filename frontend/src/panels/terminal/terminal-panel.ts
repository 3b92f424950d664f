import { h } from "../../dom";
import type { TerminalsState } from "../../state/terminals";
import type { ThemeState } from "../../state/theme";
import { openBrowserStorage } from "../../storage";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import type { TerminalDeck } from "./terminal-deck";

/** The panel of the terminals, whose code is loaded when the panel is first shown. */
export class TerminalPanel implements Panel {
  readonly id = "terminal";
  readonly icon = "terminal";
  readonly element: HTMLElement;
  private readonly notice = h("p", { class: "empty" }, strings.terminal.off);
  private deck: TerminalDeck | null = null;
  private isVisible = false;
  private isLoading = false;

  constructor(
    private readonly state: TerminalsState,
    private readonly theme: ThemeState,
  ) {
    this.element = h("div", { class: "panel terminal-panel" }, this.notice);
    onVisibilityChange(this.element, (isVisible) => {
      this.isVisible = isVisible;
      this.update();
    });
    state.availabilityChanged.on(() => this.update());
  }

  inspect(): object {
    return { available: this.state.isAvailable, ...this.deck?.inspect() };
  }

  private update(): void {
    const { isAvailable } = this.state;
    this.notice.hidden = isAvailable && this.deck !== null;
    this.notice.textContent = isAvailable ? strings.terminal.loading : strings.terminal.off;
    if (this.deck) {
      this.deck.element.hidden = !isAvailable;
      this.deck.setVisible(this.isVisible && isAvailable);
    } else if (isAvailable && this.isVisible && !this.isLoading) void this.load();
  }

  private async load(): Promise<void> {
    this.isLoading = true;
    try {
      const { TerminalDeck } = await import("./terminal-deck");
      this.deck = new TerminalDeck(this.state, this.theme, openBrowserStorage());
      this.element.append(this.deck.element);
      this.update();
    } catch {
      this.notice.textContent = strings.terminal.failed;
    }
    this.isLoading = false;
  }
}
