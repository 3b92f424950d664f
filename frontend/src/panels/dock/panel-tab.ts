import type { ITabRenderer, TabPartInitParameters } from "dockview";
import { h } from "../../dom";
import { createIcon, type IconName } from "../../icons";
import { strings } from "../../strings";

/** A panel's tab: icon, title and, if the panel can be closed, a close button. */
export class PanelTab implements ITabRenderer {
  readonly element = h("div", { class: "panel-tab" });
  private readonly title = h("span", { class: "tab-title" });

  constructor(
    private readonly iconName: IconName,
    private readonly isClosable: boolean,
    private readonly onClose: (() => void) | null = null,
  ) {}

  /** Closes the panel and returns true; returns false if the panel cannot be closed. */
  close: () => boolean = () => false;

  init({ title, api }: TabPartInitParameters): void {
    this.title.textContent = title;
    api.onDidTitleChange((event) => (this.title.textContent = event.title));
    this.element.append(createIcon(this.iconName), this.title);
    if (!this.isClosable) return;
    this.close = () => {
      if (this.onClose) this.onClose();
      else api.close();
      return true;
    };
    // A tab cannot contain another focusable element: keyboard users close the panel with Delete.
    const closeIcon = h("span", { class: "tab-close", title: strings.closeTab, aria: { hidden: "true" } }, createIcon("close"));
    // Pressing the close button must not start a drag of the tab.
    closeIcon.addEventListener("pointerdown", (event) => event.stopPropagation());
    closeIcon.addEventListener("click", () => this.close());
    this.element.append(closeIcon);
  }
}
