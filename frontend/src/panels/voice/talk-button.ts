import { h } from "../../dom";
import { icon } from "../../icons";
import type { VoiceState } from "../../state/voice/voice";
import { strings } from "../../strings";

/** The key that talks while it is held. */
export const TALK_KEY = "v";

/** A button that talks while it is held, with the pointer, with Space or with Enter. */
export function talkButton(voice: VoiceState, className: string, ...words: readonly string[]): HTMLButtonElement {
  const { talk, talkHint } = strings.voice;
  const named = words.length > 0 ? {} : { label: talk };
  const element = h("button", { class: className, title: talkHint, aria: named }, icon("microphone"), ...words);
  element.type = "button";
  element.setAttribute("aria-keyshortcuts", TALK_KEY);
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    voice.press();
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) {
    element.addEventListener(end, () => voice.release());
  }
  element.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    if (!event.repeat) voice.press();
  });
  element.addEventListener("keyup", (event) => {
    if (event.key === " " || event.key === "Enter") voice.release();
  });
  // A finger that rests on it does not request a menu.
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  const show = (): void => {
    const talking = voice.held || voice.open;
    element.setAttribute("aria-pressed", String(talking));
    element.classList.toggle("talking", talking);
    element.classList.toggle("wrong", voice.microphone.problem !== null);
  };
  voice.changed.on(show);
  show();
  return element;
}

/** The key that talks, anywhere but where text is typed; and an end to all of it when the page is left. */
export function takeTalkKey(voice: VoiceState, takesLetters: string): void {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey) return;
    if (event.key.toLowerCase() !== TALK_KEY) return;
    if (event.target instanceof Element && event.target.closest(takesLetters)) return;
    event.preventDefault();
    if (!event.repeat) voice.press();
  });
  document.addEventListener("keyup", (event) => {
    if (event.key.toLowerCase() === TALK_KEY) voice.release();
  });
  window.addEventListener("blur", () => voice.release());
  window.addEventListener("pagehide", () => voice.letGo());
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) voice.letGo();
  });
}
