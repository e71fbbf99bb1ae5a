// By what the body is found: by its outline alone, or by its shading as well; and what covers it.
import { clothing, cues } from "../draft/draft";
import { Choice } from "../ui/Choice";

export function EvidencePanel() {
  return (
    <div class="subsection">
      <Choice
        name="cues"
        legend="Evidence"
        options={[
          { value: "SES", label: "Outline and shading" },
          { value: "SE", label: "Outline alone" },
        ]}
        value={cues.value}
        onChange={(value) => (cues.value = value)}
      />
      <p class="fine">
        {cues.value === "SES"
          ? "Shading measures better where skin, or what clings to it, is seen in one light. It takes twice as long."
          : "For paintings and light from everywhere. Nothing is said of light and skin then."}
      </p>
      <Choice
        name="clothing"
        legend="Clothes"
        options={[
          { value: "tight", label: "Close-fitting or none" },
          { value: "loose", label: "Loose" },
        ]}
        value={clothing.value}
        onChange={(value) => (clothing.value = value)}
      />
      <p class="fine">
        {clothing.value === "tight"
          ? "The outline is the body’s own."
          : "The body is sought inside the outline, tight only where skin is seen. Intervals are wider."}
      </p>
    </div>
  );
}
