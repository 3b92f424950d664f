import type { Connection } from "../connection/connection";
import { extractToken, type Tokens } from "../connection/tokens";
import { createButton, h } from "../dom";
import { strings } from "../strings";
import { createLogo } from "../widgets/logo";

/** The screen over everything while the page has no valid token: where to find the token, and a field for it. */
export class TokenScreen {
  readonly element: HTMLElement;
  private readonly tokenField = h("input", { class: "field wide", aria: { label: strings.door.label } });
  private readonly problem = h("p", { class: "problem", role: "alert" });
  private wasConnected = false;

  constructor(
    private readonly connection: Connection,
    private readonly tokens: Tokens,
    private readonly page: HTMLElement,
  ) {
    const texts = strings.door;
    this.tokenField.placeholder = `${location.origin}/?token=…`;
    this.tokenField.spellcheck = false;
    this.tokenField.autocomplete = "off";
    const form = h("form", {}, this.tokenField, createButton(texts.open, () => this.submit(), "tool framed primary", texts.open));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.submit();
    });
    this.element = h(
      "div",
      { class: "door", role: "dialog", aria: { modal: "true", label: texts.title } },
      h(
        "div",
        { class: "door-box" },
        h("header", {}, createLogo(), h("h1", {}, texts.title)),
        h("p", {}, texts.printed),
        h("code", {}, `Viewer: ${location.origin}/?token=…`),
        h("p", {}, texts.hint),
        form,
        this.problem,
      ),
    );
    this.element.hidden = true;
    connection.stateChanged.on(() => this.update());
    this.update();
  }

  private update(): void {
    const { state } = this.connection;
    if (state === "connected") {
      this.wasConnected = true;
      this.show(false);
    }
    // A page that was connected earlier continues to show its content, with a notice.
    if (state !== "refused" || this.wasConnected) return;
    if (this.tokens.current !== null) this.problem.textContent = strings.door.unknown;
    this.show(true);
  }

  private show(isShown: boolean): void {
    this.page.inert = isShown;
    if (isShown !== this.element.hidden) return;
    this.element.hidden = !isShown;
    if (isShown) this.tokenField.focus();
  }

  private submit(): void {
    const token = extractToken(this.tokenField.value);
    this.problem.textContent = token === null ? strings.door.noToken : "";
    if (token === null) {
      this.tokenField.focus();
      return;
    }
    this.connection.connectWith(token);
  }
}
