const SVG_NAMESPACE = "http://www.w3.org/2000/svg";

/** Returns the logo: two links and the joint between them. */
export function createLogo(): SVGSVGElement {
  const svg = document.createElementNS(SVG_NAMESPACE, "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("class", "logo");
  svg.setAttribute("aria-hidden", "true");
  const appendShape = (tag: string, attributes: Readonly<Record<string, string>>): void => {
    const element = document.createElementNS(SVG_NAMESPACE, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    svg.append(element);
  };
  appendShape("path", { d: "M4.5 15.5L9.5 6.5L16 10.5", class: "logo-links" });
  appendShape("circle", { cx: "4.5", cy: "15.5", r: "2", class: "logo-end" });
  appendShape("circle", { cx: "16", cy: "10.5", r: "2", class: "logo-end" });
  appendShape("circle", { cx: "9.5", cy: "6.5", r: "2.8", class: "logo-joint" });
  return svg;
}
