import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { LinkScene, LinkProvenance } from "../../protocol";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { formatPlace, shortenPath } from "../place";
import type { CardColumn } from "./card-column";

/** The selected link: its place in the files, and the macros that it came from. */
export class SelectionCard {
  readonly element = h("div", { class: "selection-card", role: "status" });

  private isFolded = false;

  /**
   * @param column - the column of the card. A card that would cover a robot is folded until the user unfolds it.
   * @param startEditing - starts editing the link; null if links cannot be edited.
   */
  constructor(
    private readonly session: Session,
    private readonly column: CardColumn,
    private readonly startEditing: (() => void) | null = null,
  ) {
    session.selection.changed.on(() => this.update());
    session.provenanceAnswered.on((provenance) => this.show(provenance));
    session.editing.activeChanged.on(() => this.update());
    this.update();
  }

  private update(): void {
    const { selectedLink } = this.session.selection;
    const wasHidden = this.element.hidden;
    // While the link is edited, the Editing panel shows it, and its handles need the space.
    this.element.hidden = !selectedLink || this.session.editing.isActive;
    if (!selectedLink || this.session.editing.isActive) {
      if (!wasHidden && !this.isFolded) this.column.onCardToggled();
      return;
    }
    if (wasHidden) this.isFolded = this.column.isOverRobots;
    const { link } = selectedLink;
    const texts = strings.selection;
    const clearButton = createButton(texts.clear, () => this.session.selection.select(null), "tool bare", createIcon("close"));
    const editButton = this.startEditing && createButton(strings.editing.editHint, this.startEditing, "tool bare edit-link", createIcon("handles"));
    this.element.replaceChildren(
      h("header", {}, createIcon("cube"), h("strong", { title: texts.title }, link.name), h("span", { class: "spacer" }), editButton, this.createFoldButton(), clearButton),
      ...createDetails(link),
      createPlace(link, (file, line) => this.session.description.placeRequested.emit({ file, line })),
      ...createTrail(link),
    );
    if (link.place) this.session.connection.send({ type: "request_provenance", display: selectedLink.display, link: link.name });
  }

  /** Returns the button that folds the card to the link's name, or unfolds it. */
  private createFoldButton(): HTMLButtonElement {
    const texts = strings.selection;
    const toggle = (): void => {
      show(!this.isFolded);
      this.column.onCardToggled();
    };
    const foldButton: HTMLButtonElement = createButton(texts.fold, toggle, "tool bare fold", createIcon("chevron"));
    const show = (isFolded: boolean): void => {
      this.isFolded = isFolded;
      this.element.classList.toggle("folded", isFolded);
      foldButton.setAttribute("aria-expanded", String(!isFolded));
    };
    show(this.isFolded);
    return foldButton;
  }

  /** Replaces the plain trail with the calls and values, which the server sends later. */
  private show(provenance: LinkProvenance): void {
    const selectedLink = this.session.selection.selectedLink;
    if (selectedLink?.display !== provenance.display || selectedLink.link.name !== provenance.link) return;
    for (const element of this.element.querySelectorAll(".trail, .provenance")) element.remove();
    const [, ...lines] = provenance.lines; // the first is the place, which the card shows already
    if (lines.length > 0) this.element.append(h("pre", { class: "provenance", tabIndex: 0 }, lines.join("\n")));
  }
}

function createDetails(link: LinkScene): HTMLElement[] {
  const texts = strings.selection;
  const rows: [string, string][] = [];
  if (link.parent_joint !== null) rows.push([texts.joint, link.parent_joint]);
  if (link.frame !== link.name) rows.push([texts.frame, link.frame]);
  return rows.map(([name, value]) => h("div", { class: "detail" }, h("span", {}, name), h("span", {}, value)));
}

function createPlace(link: LinkScene, showSource: (file: string, line: number) => void): HTMLElement {
  const texts = strings.selection;
  const place = link.place;
  if (!place) return h("p", { class: "hint" }, texts.noPlace);
  const fullPlace = formatPlace(place.file, place.line, place.column);
  const copyButton = createButton(
    texts.copy,
    () => {
      void navigator.clipboard.writeText(fullPlace).then(() => {
        copyButton.classList.add("done");
        copyButton.title = texts.copied;
      });
    },
    "tool bare",
    createIcon("copy"),
  );
  const shortPlace = formatPlace(shortenPath(place.file), place.line, place.column);
  const placeButton = createButton(fullPlace, () => showSource(place.file, place.line), "place", createIcon("file"), shortPlace);
  return h("div", { class: "card-place" }, placeButton, copyButton);
}

function createTrail(link: LinkScene): HTMLElement[] {
  const steps = link.place?.trail ?? [];
  if (steps.length === 0) return [];
  return [h("ol", { class: "trail" }, ...steps.map((step) => h("li", {}, step)))];
}
