import { h } from "../dom";

/** The number of rows drawn beyond both ends of the visible part, so that scrolling shows no gaps. */
const OVERSCAN_ROWS = 12;

/** A list of any length in which only the visible rows, which have the same height, are elements. */
export class VirtualRows {
  readonly element: HTMLElement;
  /** The element that contains the rows, as high as all of them. */
  readonly body = h("div", { class: "virtual-body" });
  private count = 0;
  private firstIndex = 0;
  private rows: HTMLElement[] = [];

  /**
   * @param rowHeight - px.
   * @param renderRow - returns the row of an index.
   */
  constructor(
    className: string,
    readonly rowHeight: number,
    private readonly renderRow: (index: number) => HTMLElement,
  ) {
    this.element = h("div", { class: `virtual ${className}`, tabIndex: 0 }, this.body);
    this.element.addEventListener("scroll", () => this.draw(false), { passive: true });
    new ResizeObserver(() => this.draw(false)).observe(this.element);
  }

  /** Redraws after rows were added, removed or changed. */
  refresh(count = this.count): void {
    this.count = count;
    this.body.style.height = `${count * this.rowHeight}px`;
    this.draw(true);
  }

  /** Returns the row of an index, if it is drawn now. */
  rowAt(index: number): HTMLElement | undefined {
    return this.rows[index - this.firstIndex];
  }

  /** Scrolls a row that is out of view to a third of the height. */
  reveal(index: number): void {
    const { element, rowHeight } = this;
    const top = index * rowHeight;
    if (top >= element.scrollTop && top + rowHeight <= element.scrollTop + element.clientHeight) return;
    element.scrollTop = Math.max(0, top - element.clientHeight / 3);
    this.draw(false);
  }

  private draw(isStale: boolean): void {
    const { scrollTop, clientHeight } = this.element;
    const firstIndex = Math.max(0, Math.floor(scrollTop / this.rowHeight) - OVERSCAN_ROWS);
    const endIndex = Math.min(this.count, Math.ceil((scrollTop + clientHeight) / this.rowHeight) + OVERSCAN_ROWS);
    if (!isStale && firstIndex === this.firstIndex && endIndex === this.firstIndex + this.rows.length) return;
    const reusableRows = isStale ? [] : this.rows;
    const previousFirst = this.firstIndex;
    this.rows = Array.from({ length: Math.max(0, endIndex - firstIndex) }, (_, i) => reusableRows[firstIndex + i - previousFirst] ?? this.createRow(firstIndex + i));
    this.firstIndex = firstIndex;
    this.body.replaceChildren(...this.rows);
  }

  private createRow(index: number): HTMLElement {
    const row = this.renderRow(index);
    row.style.top = `${index * this.rowHeight}px`;
    return row;
  }
}
