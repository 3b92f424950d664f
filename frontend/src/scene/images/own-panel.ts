import { h } from "../../dom";
import type { IconName } from "../../icons";
import { isSceneEmpty } from "../../state/displays";
import type { Session } from "../../state/session";
import type { DrawingContext } from "../displays/drawing";

/** The panel of an Image or Camera display, which is open while the display is enabled, as in RViz. */
export class OwnPanel {
  readonly element: HTMLElement;
  private readonly notice = h("p", { class: "image-notice" });
  private readonly key: string;
  private title = "";
  private isOpen = false;

  constructor(
    private readonly context: DrawingContext,
    private readonly icon: IconName,
    private readonly canvas: HTMLCanvasElement,
  ) {
    this.key = `display:${context.display.id}`;
    canvas.setAttribute("role", "img");
    this.element = h("div", { class: "image-panel" }, canvas, this.notice);
  }

  /** Shows a text over the image or in its place, and its cause if known; an empty text shows nothing. */
  showText(text: string, cause = ""): void {
    this.notice.replaceChildren(text, ...(cause === "" ? [] : [h("small", {}, cause)]));
    this.notice.hidden = text === "";
  }

  /** Whether the panel is visible to the user. */
  get isVisible(): boolean {
    return this.element.clientWidth > 0 && this.element.clientHeight > 0;
  }

  /** Opens, closes and titles the panel to match the display. */
  update(): void {
    const { display, panels, session } = this.context;
    this.canvas.setAttribute("aria-label", display.name);
    if (!display.isEnabled) {
      this.close();
    } else if (!this.isOpen) {
      this.isOpen = true;
      this.title = display.name;
      const onClosed = (): void => session.setProperty(display.enabledId, false);
      panels.offer({ key: this.key, title: this.title, icon: this.icon, element: this.element, replacesScene: showsOnlyImages(session), onClosed });
    } else if (this.title !== display.name) {
      this.title = display.name;
      panels.retitle(this.key, this.title);
    }
  }

  close(): void {
    if (this.isOpen) this.context.panels.withdraw(this.key);
    this.isOpen = false;
  }
}

/** Whether the page shows a recording with only its image displays enabled. */
function showsOnlyImages({ timeline, displays }: Session): boolean {
  return timeline.timeline?.live === false && isSceneEmpty(displays);
}
