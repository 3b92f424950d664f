import { button, h } from "../dom";
import { icon } from "../icons";
import type { Session } from "../state/session";
import { chooseLanguage, language, strings } from "../strings";
import type { Dock } from "./dock";
import { Logo } from "./logo";
import { openMenu } from "./menu";
import type { PanelId } from "./panel";

/** Name and title at the head of the page, and what concerns all of it. */
export class TitleBar {
  readonly element: HTMLElement;
  private readonly title = h("span", { class: "document-title" });

  constructor(session: Session, dock: Dock) {
    const words = strings.titlebar;
    const panels: HTMLButtonElement = button(
      words.panels,
      () => openMenu(panels, menuEntries(dock, session)),
      "tool",
      icon("panels"),
      words.panels,
    );
    panels.setAttribute("aria-haspopup", "menu");
    this.element = h(
      "header",
      { class: "title-bar" },
      Logo(),
      h("span", { class: "brand" }, "Linkwright"),
      this.title,
      h("span", { class: "spacer" }),
      panels,
      button(
        words.languageHint,
        () => chooseLanguage(language === "en" ? "zh" : "en"),
        "tool",
        icon("language"),
        words.language,
      ),
    );
    session.greeted.on(({ title, version }) => {
      this.title.textContent = title;
      this.element.title = `Linkwright ${version}`;
      document.title = title ? `${title} - Linkwright` : "Linkwright";
    });
  }
}

function menuEntries(dock: Dock, session: Session): Parameters<typeof openMenu>[1] {
  const ids: PanelId[] = ["displays", "views", "joints", "diagnostics"];
  return [
    ...ids
      .filter((id) => id !== "joints" || session.joints.controls !== null)
      .map((id) => ({
        label: strings.panels[id],
        checked: dock.isOpen(id),
        run: () => (dock.isOpen(id) ? dock.close(id) : dock.open(id)),
      })),
    { label: strings.titlebar.resetLayout, run: () => dock.reset() },
  ];
}
