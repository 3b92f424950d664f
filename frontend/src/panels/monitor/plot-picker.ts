import { h } from "../../dom";
import type { TopicFields } from "../../protocol";
import { formatField, parseField, type FieldName } from "../../state/monitor/field-text";
import type { PlotsState } from "../../state/monitor/plots";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";

const MAX_OFFERS = 200;

interface Offer {
  text: string;
  note: string;
  /** Whether choosing it completes the choice: it is a field, not a topic. */
  isField: boolean;
}

/** An input for a topic and its field, with a list of matching ones below. */
export class PlotPicker {
  readonly element: HTMLElement;
  private readonly input = h("input", { class: "field", role: "combobox", aria: { autocomplete: "list" } });
  private readonly list = h("ul", { class: "picker-list", role: "listbox" });
  private offers: Offer[] = [];
  private activeIndex = 0;
  private fields: TopicFields | null = null;
  private requestedTopic: string | null = null;
  private readonly unsubscribe: (() => void)[];

  constructor(
    private readonly plots: PlotsState,
    private readonly topics: TopicsState,
    private readonly onFieldChosen: (field: FieldName) => void,
    private readonly onClosed: () => void,
  ) {
    const texts = strings.monitor.plot;
    this.input.placeholder = texts.choose;
    for (const element of [this.input, this.list]) element.setAttribute("aria-label", texts.choose);
    this.list.id = "picker-list";
    this.input.setAttribute("aria-controls", this.list.id);
    this.input.setAttribute("aria-expanded", "true");
    this.input.spellcheck = false;
    this.input.addEventListener("input", () => this.onInput());
    this.input.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.input.addEventListener("blur", () => this.close());
    // The list must not take the focus from the input.
    this.list.addEventListener("pointerdown", (event) => event.preventDefault());
    this.element = h("div", { class: "picker" }, this.input, this.list);
    topics.watchList(this, true);
    this.unsubscribe = [
      topics.listChanged.on(() => this.updateOffers()),
      plots.fieldsArrived.on((fields) => {
        if (fields.topic !== this.requestedTopic) return;
        this.fields = fields;
        this.updateOffers();
      }),
    ];
    this.updateOffers();
  }

  focus(): void {
    this.input.focus();
  }

  close(): void {
    if (this.unsubscribe.length === 0) return;
    for (const unsubscribe of this.unsubscribe.splice(0)) unsubscribe();
    this.topics.watchList(this, false);
    this.plots.requestFields(null);
    this.element.remove();
    this.onClosed();
  }

  private onInput(): void {
    const topic = this.parseTypedTopic();
    if (topic !== this.requestedTopic) {
      this.requestedTopic = topic;
      this.fields = null;
      this.plots.requestFields(topic);
    }
    this.activeIndex = 0;
    this.updateOffers();
  }

  /** Returns the topic whose fields are to be offered: the text before the dot. */
  private parseTypedTopic(): string | null {
    const dot = this.input.value.indexOf(".");
    return dot > 0 ? this.input.value.slice(0, dot).trim() : null;
  }

  private updateOffers(): void {
    const query = this.input.value.trim().toLowerCase();
    this.offers =
      this.requestedTopic === null
        ? this.topics.topics.map(({ name, types }) => ({ text: name, note: types.join(", "), isField: false }))
        : (this.fields?.fields ?? []).map(({ path, kind }) => ({
            text: formatField({ topic: this.requestedTopic ?? "", path }),
            note: kind,
            isField: true,
          }));
    this.offers = this.offers.filter(({ text }) => text.toLowerCase().includes(query)).slice(0, MAX_OFFERS);
    this.activeIndex = Math.min(this.activeIndex, Math.max(0, this.offers.length - 1));
    this.show();
  }

  private show(): void {
    const texts = strings.monitor.plot;
    const rows = this.offers.map((offer, index) => {
      const row = h("li", { role: "option" }, h("span", {}, offer.text), h("span", { class: "note" }, offer.note));
      row.id = `picker-${index}`;
      row.setAttribute("aria-selected", String(index === this.activeIndex));
      row.addEventListener("click", () => this.chooseOffer(offer));
      return row;
    });
    const noTopicsText = this.topics.isKnown ? texts.noTopics : texts.requestingTopics;
    const noFieldsText = this.fields ? (this.fields.error ?? texts.noFields) : texts.waiting;
    const emptyText = this.requestedTopic === null ? noTopicsText : noFieldsText;
    this.list.replaceChildren(...(rows.length > 0 ? rows : [h("li", { class: "note", role: "option", aria: { disabled: "true" } }, emptyText)]));
    this.input.setAttribute("aria-activedescendant", rows.length > 0 ? `picker-${this.activeIndex}` : "");
    rows[this.activeIndex]?.scrollIntoView({ block: "nearest" });
  }

  private onKeyDown(event: KeyboardEvent): void {
    const lastIndex = this.offers.length - 1;
    if (event.key === "ArrowDown") this.activeIndex = Math.min(lastIndex, this.activeIndex + 1);
    else if (event.key === "ArrowUp") this.activeIndex = Math.max(0, this.activeIndex - 1);
    else if (event.key === "Enter") this.acceptTyped();
    else if (event.key === "Tab" && this.offers[this.activeIndex]?.isField === false) this.chooseOffer(this.offers[this.activeIndex]);
    else if (event.key === "Escape") this.close();
    else {
      event.stopPropagation();
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    if (this.unsubscribe.length > 0) this.show();
  }

  /** Accepts a field that is typed in full even if it is not offered: arrays have more elements than are listed. */
  private acceptTyped(): void {
    const field = parseField(this.input.value);
    const offer = this.offers[this.activeIndex];
    const typedOffer = this.offers.find(({ text }) => text === this.input.value.trim());
    if (offer && !typedOffer) this.chooseOffer(offer);
    else if (field) this.acceptField(field);
    else if (offer) this.chooseOffer(offer);
  }

  private chooseOffer(offer: Offer | undefined): void {
    if (!offer) return;
    const field = offer.isField ? parseField(offer.text) : null;
    if (field) {
      this.acceptField(field);
      return;
    }
    this.input.value = `${offer.text}.`;
    this.onInput();
  }

  private acceptField(field: FieldName): void {
    this.onFieldChosen(field);
    this.close();
  }
}
