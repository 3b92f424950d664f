import type { ITabRenderer, TabPartInitParameters } from "dockview";
import { button, h } from "../dom";
import { icon, type IconName } from "../icons";
import { strings } from "../strings";

/** A panel's tab: icon, title and, unless the panel must stay, a close button. */
export class PanelTab implements ITabRenderer {
  readonly element = h("div", { class: "panel-tab" });
  private readonly title = h("span", { class: "tab-title" });

  constructor(
    private readonly iconName: IconName,
    private readonly closable: boolean,
    private readonly onClose: (() => void) | null = null,
  ) {}

  init({ title, api }: TabPartInitParameters): void {
    this.title.textContent = title;
    api.onDidTitleChange((event) => (this.title.textContent = event.title));
    this.element.append(icon(this.iconName), this.title);
    if (!this.closable) return;
    const close = button(strings.close, () => (this.onClose ? this.onClose() : api.close()), "tab-close", icon("close"));
    // Pressing the button must not start to drag the tab.
    close.addEventListener("pointerdown", (event) => event.stopPropagation());
    this.element.append(close);
  }
}
