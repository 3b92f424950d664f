import { coalesce, h } from "../dom";

/** The number of rows kept ready beyond the visible ones. */
const OVERSCAN_ROWS = 8;

/**
 * A list that scrolls to its end as items are added, until the user scrolls up. Only the visible rows, which have the
 * same height, are elements.
 */
export class FollowingList<T> {
  readonly element = h("div", { class: "virtual-list", tabIndex: 0 });
  /** Whether the list scrolls to the end when rows are added. */
  isFollowing = true;
  private readonly rows = h("div", { class: "virtual-rows" });
  private readonly spacer = h("div", { class: "virtual-space" }, this.rows);
  private items: readonly T[] = [];
  private firstIndex = -1;
  private endIndex = -1;
  private readonly scheduleRender = coalesce(() => this.renderVisibleRows());

  constructor(
    private readonly rowHeight: number,
    private readonly createRow: (item: T, index: number) => HTMLElement,
    private readonly onFollowingChanged: () => void,
  ) {
    this.element.append(this.spacer);
    this.element.addEventListener("scroll", () => this.onScroll());
    new ResizeObserver(() => this.scheduleRender()).observe(this.element);
  }

  show(items: readonly T[]): void {
    this.items = items;
    this.firstIndex = -1;
    this.scheduleRender();
  }

  /** Scrolls to the end and follows it. */
  follow(): void {
    this.isFollowing = true;
    this.onFollowingChanged();
    this.scheduleRender();
  }

  private onScroll(): void {
    const { scrollTop, clientHeight, scrollHeight } = this.element;
    const isAtEnd = scrollTop + clientHeight >= scrollHeight - this.rowHeight;
    if (isAtEnd !== this.isFollowing) {
      this.isFollowing = isAtEnd;
      this.onFollowingChanged();
    }
    this.renderVisibleRows();
  }

  private renderVisibleRows(): void {
    const { element, items, rowHeight } = this;
    const height = element.clientHeight;
    if (height === 0) return;
    const totalHeight = `${items.length * rowHeight}px`;
    if (this.spacer.style.height !== totalHeight) this.spacer.style.height = totalHeight;
    if (this.isFollowing) element.scrollTop = items.length * rowHeight;
    const firstIndex = Math.max(0, Math.floor(element.scrollTop / rowHeight) - OVERSCAN_ROWS);
    const endIndex = Math.min(items.length, Math.ceil((element.scrollTop + height) / rowHeight) + OVERSCAN_ROWS);
    if (firstIndex === this.firstIndex && endIndex === this.endIndex) return;
    [this.firstIndex, this.endIndex] = [firstIndex, endIndex];
    this.rows.style.transform = `translateY(${firstIndex * rowHeight}px)`;
    this.rows.replaceChildren(...items.slice(firstIndex, endIndex).map((item, index) => this.createRow(item, firstIndex + index)));
  }
}
