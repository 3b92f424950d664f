import { createButton, h } from "../dom";
import { createIcon } from "../icons";
import { strings } from "../strings";

export interface DialogChoice {
  label: string;
  /** Called on a click; the dialog closes afterwards unless this returns false. */
  run?: () => boolean | undefined;
  /** Whether Enter runs this choice. */
  isPrimary?: boolean;
  isDangerous?: boolean;
}

/** A question or form over the page. The browser keeps the focus within it, and restores the focus when it closes. */
export class Dialog {
  readonly element: HTMLDialogElement;
  private readonly primaryButton: HTMLButtonElement | null;

  constructor(title: string, content: readonly (Node | string)[], choices: readonly DialogChoice[], className = "") {
    const buttons = choices.map((choice) => {
      const element = createButton(
        choice.label,
        () => {
          if (choice.run?.() !== false) this.close();
        },
        `tool framed${choice.isPrimary === true ? " primary" : ""}${choice.isDangerous === true ? " danger" : ""}`,
        choice.label,
      );
      return { element, choice };
    });
    this.primaryButton = buttons.find(({ choice }) => choice.isPrimary === true)?.element ?? null;
    const heading = h("h2", {}, title);
    heading.id = `dialog-${String(++dialogCount)}`;
    const closeButton = createButton(strings.close, () => this.close(), "tool bare", createIcon("close"));
    this.element = h(
      "dialog",
      { class: `dialog ${className}`.trim(), aria: { labelledby: heading.id } },
      h("header", {}, heading, h("span", { class: "spacer" }), closeButton),
      h("div", { class: "dialog-body" }, ...content),
      h("footer", {}, ...buttons.map(({ element }) => element)),
    );
    this.element.addEventListener("close", () => this.element.remove());
    // The page's own keys must not act while a dialog is open.
    this.element.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Tab") this.wrapFocus(event);
      const { target } = event;
      if (event.key !== "Enter" || !(target instanceof HTMLInputElement) || event.isComposing) return;
      event.preventDefault();
      this.primaryButton?.click();
    });
  }

  open(focus?: HTMLElement): this {
    document.body.append(this.element);
    this.element.showModal();
    (focus ?? this.primaryButton)?.focus();
    return this;
  }

  close(): void {
    this.element.close();
  }

  /** Moves the focus from the last element to the first on Tab, where the browser would move it to its own buttons. */
  private wrapFocus(event: KeyboardEvent): void {
    const elements = this.element.querySelectorAll<HTMLElement>("button, input, select, textarea, [tabindex]");
    const focusableElements = [...elements].filter((element) => element.tabIndex >= 0 && !element.matches(":disabled") && element.checkVisibility());
    const [firstElement, lastElement] = [focusableElements[0], focusableElements.at(-1)];
    const edgeElement = event.shiftKey ? firstElement : lastElement;
    if (document.activeElement !== edgeElement) return;
    event.preventDefault();
    (event.shiftKey ? lastElement : firstElement)?.focus();
  }

  /** Whether the main choice is enabled. */
  set isReady(isReady: boolean) {
    if (this.primaryButton) this.primaryButton.disabled = !isReady;
  }
}

let dialogCount = 0;

/** Shows a notice to the user; `lines` lists its subjects below the text. */
export function showNotice(title: string, text: string, lines: readonly string[] = []): void {
  const list = h("ul", { class: "dialog-lines" }, ...lines.map((line) => h("li", {}, line)));
  const content = lines.length > 0 ? [h("p", {}, text), list] : [h("p", {}, text)];
  new Dialog(title, content, [{ label: strings.shell.ok, isPrimary: true }]).open();
}

/** Asks for a name. */
export function askName(title: string, label: string, value: string, onNamed: (name: string) => void): void {
  const field = h("input", { class: "field wide", aria: { label } });
  field.value = value;
  field.maxLength = 200;
  const confirm = (): boolean => {
    const name = field.value.trim();
    if (name === "") return false;
    if (name !== value) onNamed(name);
    return true;
  };
  const dialog = new Dialog(
    title,
    [h("label", { class: "form-field" }, h("span", {}, label), field)],
    [{ label: strings.shell.cancel }, { label: strings.shell.ok, run: confirm, isPrimary: true }],
  );
  field.addEventListener("input", () => (dialog.isReady = field.value.trim() !== ""));
  dialog.open(field);
  field.select();
}
