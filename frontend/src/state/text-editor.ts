import type { Connection } from "../connection/connection";
import type { ElementName } from "./description-model";
import { isSameElement, type ElementFocus } from "./element-focus";

/** Keeps the selected element and the cursor of a text editor together, if the program has an editor. */
export class TextEditorLink {
  private isAttached = false;
  private lastElement: ElementName | null = null;

  constructor(
    private readonly connection: Connection,
    private readonly focus: ElementFocus,
  ) {
    connection.on("editor_attached", () => (this.isAttached = true));
    connection.on("show_element", ({ display, kind, name }) => {
      this.lastElement = { display, kind, name };
      focus.select(this.lastElement);
    });
    focus.changed.on(() => this.notify());
  }

  private notify(): void {
    const { current } = this.focus;
    if (!this.isAttached || current === null || isSameElement(current, this.lastElement)) return;
    this.lastElement = current;
    this.connection.send({ type: "element_selected", ...current });
  }
}
