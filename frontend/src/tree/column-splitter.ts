import { h } from "../dom";

const MIN_SHARE = 0.2;
const MAX_SHARE = 0.8;

/** The draggable line between names and values. */
export class ColumnSplitter {
  readonly element = h("div", { class: "splitter", aria: { hidden: "true" } });

  constructor() {
    this.element.addEventListener("pointerdown", (event) => {
      this.element.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    this.element.addEventListener("pointermove", (event) => {
      const container = this.element.parentElement;
      if (!container || !this.element.hasPointerCapture(event.pointerId)) return;
      const { left, width } = container.getBoundingClientRect();
      const share = Math.min(MAX_SHARE, Math.max(MIN_SHARE, (event.clientX - left) / width));
      container.style.setProperty("--names", `${(share * 100).toFixed(1)}%`);
    });
  }
}
