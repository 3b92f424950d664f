import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TopicMessage, TopicRow, TopicTraffic } from "../../protocol";
import { formatBandwidth, formatClock, formatRate } from "../../state/monitor/figure-text";
import { strings } from "../../strings";
import { MessageTree } from "./message-tree";

/** The user's actions on a row of the topic monitor. */
export interface TopicRowEvents {
  onMeasured(topic: string, isTicked: boolean): void;
  onOpened(topic: string, isOpen: boolean): void;
  onPlotted(topic: string, path: string): void;
  /** Called when the topic is to be shown in the scene. */
  onShown(topic: string): void;
}

/** A topic of the monitor, and while it is open, its last message below it. */
export class TopicLine {
  readonly mainRow: HTMLTableRowElement;
  readonly messageRow: HTMLTableRowElement;
  private readonly measureBox = h("input", { class: "check" });
  private readonly expander: HTMLButtonElement;
  private readonly cells: Record<"type" | "publishers" | "subscribers" | "rate" | "bandwidth", HTMLElement>;
  private readonly receivedNote = h("div", { class: "note" }, strings.monitor.topics.waiting);
  private readonly tree: MessageTree;

  constructor(
    readonly name: string,
    events: TopicRowEvents,
  ) {
    const texts = strings.monitor.topics;
    this.measureBox.type = "checkbox";
    this.measureBox.setAttribute("aria-label", texts.measure(name));
    this.measureBox.addEventListener("change", () => events.onMeasured(name, this.measureBox.checked));
    this.expander = createButton(texts.open(name), () => events.onOpened(name, this.messageRow.hidden === true), "expander", createIcon("chevron"));
    this.tree = new MessageTree((path) => events.onPlotted(name, path));
    this.cells = {
      type: h("td", { class: "note" }),
      publishers: h("td", { class: "numeric" }),
      subscribers: h("td", { class: "numeric" }),
      rate: h("td", { class: "numeric" }),
      bandwidth: h("td", { class: "numeric" }),
    };
    const nameButton = createButton(texts.show, () => events.onShown(name), "text-link", name);
    const title = h("span", { class: "topic-title" }, this.measureBox, this.expander, nameButton);
    this.mainRow = h("tr", { data: { topic: name } }, h("td", { title: name }, title), ...Object.values(this.cells));
    const cell = h("td", {}, this.receivedNote, this.tree.element);
    cell.colSpan = 6;
    this.messageRow = h("tr", { class: "topic-message" }, cell);
    this.messageRow.hidden = true;
  }

  show({ types, publishers, subscribers }: TopicRow): void {
    this.cells.type.textContent = types.map((type) => type.replace("/msg/", "/")).join(", ");
    this.cells.type.title = types.join("\n");
    this.cells.type.classList.toggle("wrong", types.length > 1);
    this.cells.publishers.textContent = String(publishers);
    this.cells.subscribers.textContent = String(subscribers);
  }

  /** Sets the tick box and the expander. */
  setState(isMeasured: boolean, isOpen: boolean): void {
    this.measureBox.checked = isMeasured || isOpen;
    this.expander.setAttribute("aria-expanded", String(isOpen));
    this.messageRow.hidden = !isOpen;
  }

  showTraffic(traffic: TopicTraffic | undefined): void {
    const { rate, bandwidth } = this.cells;
    const error = traffic?.error ?? null;
    rate.textContent = typeof traffic?.rate !== "number" ? "" : strings.monitor.topics.hertz(formatRate(traffic.rate));
    bandwidth.textContent = typeof traffic?.bandwidth !== "number" ? "" : formatBandwidth(traffic.bandwidth);
    this.mainRow.classList.toggle("wrong", error !== null);
    if (error !== null) this.receivedNote.textContent = error;
  }

  showMessage({ received, fields }: TopicMessage): void {
    this.receivedNote.textContent = strings.monitor.topics.ago(formatClock(received));
    this.tree.show(fields);
  }
}
