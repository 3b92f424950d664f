import { h } from "../../dom";
import type { TopicRow } from "../../protocol";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";
import { textField, tickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { TopicLine } from "./topic-row";

/** The topics as in rqt_topic: rates of ticked topics, and the last message of open ones. */
export class TopicsPanel implements Panel {
  readonly id = "topics";
  readonly icon = "topics";
  readonly element: HTMLElement;
  private readonly body = h("tbody");
  private readonly empty = h("p", { class: "empty" }, strings.monitor.topics.none);
  private readonly lines = new Map<string, TopicLine>();
  private readonly measured = new Set<string>();
  private readonly unfolded = new Set<string>();
  private filter = "";
  private showsHidden = false;

  constructor(
    private readonly state: TopicsState,
    private readonly plot: (topic: string, path: string) => void,
    private readonly showInScene: (topic: string) => void,
  ) {
    const texts = strings.monitor.topics;
    const filter = textField(strings.monitor.filter, (text) => {
      this.filter = text.trim().toLowerCase();
      this.show();
    });
    const hidden = tickBox(texts.hidden, texts.hiddenHint, (ticked) => {
      this.showsHidden = ticked;
      this.show();
    });
    const bar = h("div", { class: "toolbar" }, filter, h("span", { class: "spacer" }), hidden);
    const head = (text: string, hint = text, numeric = true): HTMLElement =>
      h("th", { class: numeric ? "numeric" : "", title: hint }, text);
    const table = h(
      "table",
      { class: "topic-table" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          head(texts.name, texts.measureHint, false),
          head(texts.type, texts.type, false),
          head(texts.publishers, texts.publishersHint),
          head(texts.subscribers, texts.subscribersHint),
          head(texts.rate),
          head(texts.bandwidth),
        ),
      ),
      this.body,
    );
    this.element = h("div", { class: "panel monitor" }, bar, h("div", { class: "scroll" }, table, this.empty));
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    state.listChanged.on(() => this.show());
    state.figuresChanged.on(() => this.showFigures());
    state.messageArrived.on((message) => this.lines.get(message.topic)?.showMessage(message));
    onVisibilityChange(this.element, (seen) => {
      state.watchList(this, seen);
      state.watch(seen ? this.measured : [], seen ? this.unfolded : []);
    });
  }

  private show(): void {
    const shown = this.state.topics.filter((topic) => this.isShown(topic));
    const rows = shown.flatMap((topic) => {
      const line = this.line(topic.name);
      line.show(topic);
      line.setState(this.measured.has(topic.name), this.unfolded.has(topic.name));
      return [line.head, line.body];
    });
    const same = rows.length === this.body.childElementCount && rows.every((row, at) => row === this.body.children[at]);
    if (!same) this.body.replaceChildren(...rows);
    this.empty.hidden = rows.length > 0;
  }

  private isShown({ name }: TopicRow): boolean {
    if (!name.toLowerCase().includes(this.filter)) return false;
    return this.showsHidden || !name.split("/").some((part) => part.startsWith("_"));
  }

  private line(name: string): TopicLine {
    const known = this.lines.get(name);
    if (known) return known;
    const line = new TopicLine(name, {
      measured: (topic, ticked) => {
        setMember(this.measured, topic, ticked);
        if (!ticked) this.unfolded.delete(topic);
        this.watch();
      },
      opened: (topic, open) => {
        setMember(this.unfolded, topic, open);
        this.watch();
      },
      plotted: (topic, path) => this.plot(topic, path),
      shown: (topic) => this.showInScene(topic),
    });
    this.lines.set(name, line);
    return line;
  }

  private watch(): void {
    this.state.watch(this.measured, this.unfolded);
    this.show();
  }

  private showFigures(): void {
    for (const [name, line] of this.lines) line.showTraffic(this.state.traffic.get(name));
  }

  /** Moves to the previous or next topic with the arrow keys. */
  private onKeyDown(event: KeyboardEvent): void {
    if (event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
    const stops = [...this.body.querySelectorAll<HTMLElement>(":scope > tr[data-topic] .expander")];
    const at = stops.indexOf(document.activeElement as HTMLElement);
    if (at < 0) return;
    stops[at + (event.key === "ArrowDown" ? 1 : -1)]?.focus();
    event.preventDefault();
  }
}

function setMember(set: Set<string>, member: string, wanted: boolean): void {
  if (wanted) set.add(member);
  else set.delete(member);
}
