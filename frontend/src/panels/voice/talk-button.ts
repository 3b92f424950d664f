import { h } from "../../dom";
import { createIcon } from "../../icons";
import type { VoiceState } from "../../state/voice/voice";
import { strings } from "../../strings";

/** The key that opens the microphone while it is held. */
export const TALK_KEY = "v";

/** Returns a button that opens the microphone while it is held by pointer, Space or Enter. */
export function createTalkButton(voice: VoiceState, className: string, ...texts: readonly string[]): HTMLButtonElement {
  const { talk, talkHint } = strings.voice;
  const aria = texts.length > 0 ? {} : { label: talk };
  const element = h("button", { class: className, title: talkHint, aria }, createIcon("microphone"), ...texts);
  element.type = "button";
  element.setAttribute("aria-keyshortcuts", TALK_KEY);
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    voice.press();
  });
  for (const eventType of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) {
    element.addEventListener(eventType, () => voice.release());
  }
  element.addEventListener("keydown", (event) => {
    if (event.key !== " " && event.key !== "Enter") return;
    event.preventDefault();
    if (!event.repeat) voice.press();
  });
  element.addEventListener("keyup", (event) => {
    if (event.key === " " || event.key === "Enter") voice.release();
  });
  // A long press must not open the context menu.
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  const show = (): void => {
    const isTalking = voice.isHeld || voice.isAlwaysListening;
    element.setAttribute("aria-pressed", String(isTalking));
    element.classList.toggle("talking", isTalking);
    element.classList.toggle("wrong", voice.microphone.problem !== null);
  };
  voice.changed.on(show);
  show();
  return element;
}

/**
 * Binds the talk key, and closes the microphone when the user leaves the page.
 *
 * @param textSelector - matches the elements in which the key enters text.
 */
export function bindTalkKey(voice: VoiceState, textSelector: string): void {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey) return;
    if (event.key.toLowerCase() !== TALK_KEY) return;
    if (event.target instanceof Element && event.target.closest(textSelector)) return;
    event.preventDefault();
    if (!event.repeat) voice.press();
  });
  document.addEventListener("keyup", (event) => {
    if (event.key.toLowerCase() === TALK_KEY) voice.release();
  });
  window.addEventListener("blur", () => voice.release());
  window.addEventListener("pagehide", () => voice.releaseMicrophone());
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) voice.releaseMicrophone();
  });
}
