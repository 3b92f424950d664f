import { coalesce, h } from "../dom";

/** The number of rows kept ready beyond the visible ones. */
const OVERSCAN = 8;

/** A list of any length in which only the visible rows are elements; all rows have the same height. */
export class VirtualList<T> {
  readonly element = h("div", { class: "virtual-list", tabIndex: 0 });
  /** Whether the list scrolls to the end when rows are added. */
  isFollowing = true;
  private readonly rows = h("div", { class: "virtual-rows" });
  private readonly space = h("div", { class: "virtual-space" }, this.rows);
  private items: readonly T[] = [];
  private first = -1;
  private last = -1;
  private readonly draw = coalesce(() => this.fill());

  constructor(
    private readonly rowHeight: number,
    private readonly createRow: (item: T, index: number) => HTMLElement,
    private readonly onFollowingChanged: () => void,
  ) {
    this.element.append(this.space);
    this.element.addEventListener("scroll", () => this.onScroll());
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  show(items: readonly T[]): void {
    this.items = items;
    this.first = -1;
    this.draw();
  }

  /** Scrolls to the end and follows it. */
  follow(): void {
    this.isFollowing = true;
    this.onFollowingChanged();
    this.draw();
  }

  private onScroll(): void {
    const { scrollTop, clientHeight, scrollHeight } = this.element;
    const isAtEnd = scrollTop + clientHeight >= scrollHeight - this.rowHeight;
    if (isAtEnd !== this.isFollowing) {
      this.isFollowing = isAtEnd;
      this.onFollowingChanged();
    }
    this.fill();
  }

  private fill(): void {
    const { element, items, rowHeight } = this;
    const height = element.clientHeight;
    if (height === 0) return;
    const totalHeight = `${items.length * rowHeight}px`;
    if (this.space.style.height !== totalHeight) this.space.style.height = totalHeight;
    if (this.isFollowing) element.scrollTop = items.length * rowHeight;
    const first = Math.max(0, Math.floor(element.scrollTop / rowHeight) - OVERSCAN);
    const last = Math.min(items.length, Math.ceil((element.scrollTop + height) / rowHeight) + OVERSCAN);
    if (first === this.first && last === this.last) return;
    [this.first, this.last] = [first, last];
    this.rows.style.transform = `translateY(${first * rowHeight}px)`;
    this.rows.replaceChildren(...items.slice(first, last).map((item, index) => this.createRow(item, first + index)));
  }
}
