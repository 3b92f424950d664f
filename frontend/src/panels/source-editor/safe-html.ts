const ALLOWED_TAGS = new Set("A B BLOCKQUOTE BR CODE DEL EM H1 H2 H3 H4 H5 H6 HR I LI OL P PRE SPAN STRONG TABLE TBODY TD TH THEAD TR UL".split(" "));
const DROPPED_TAGS = new Set(["SCRIPT", "STYLE", "TEMPLATE", "IFRAME", "OBJECT", "EMBED", "SVG", "MATH"]);

const IMAGE_ADDRESS = /^data:image\/(?:png|jpeg|webp|gif);base64,/i;

/**
 * Returns HTML with nothing but formatted text and links to web pages: what is shown comes from the files of packages,
 * which strangers write. With `allowsImages`, images that are part of the HTML remain.
 */
export function sanitizeHtml(html: string, { allowsImages = false } = {}): string {
  const { body } = new DOMParser().parseFromString(html, "text/html");
  sanitizeChildren(body, allowsImages);
  return body.innerHTML;
}

function sanitizeChildren(element: Element, allowsImages: boolean): void {
  for (const child of [...element.children]) {
    if (DROPPED_TAGS.has(child.tagName.toUpperCase())) {
      child.remove();
      continue;
    }
    sanitizeChildren(child, allowsImages);
    const isImage = allowsImages && child.tagName === "IMG" && IMAGE_ADDRESS.test(child.getAttribute("src") ?? "");
    if (!isImage && !ALLOWED_TAGS.has(child.tagName)) {
      child.replaceWith(...child.childNodes);
      continue;
    }
    for (const { name, value } of [...child.attributes]) {
      const isLink = child.tagName === "A" && name === "href" && /^https?:\/\//i.test(value);
      const isImageAttribute = isImage && (name === "src" || name === "alt");
      const isLanguage = child.tagName === "CODE" && name === "class" && /^language-\w+$/.test(value);
      if (!isLink && !isImageAttribute && !isLanguage && !(child.tagName === "SPAN" && name === "class")) child.removeAttribute(name);
    }
    if (child.tagName === "A") {
      child.setAttribute("target", "_blank");
      child.setAttribute("rel", "noreferrer");
    }
  }
}
