// By what the body is found: by its outline alone, or by its shading as well; and what covers it.
import { clothing, cues } from "../draft/draft";
import { messages } from "../messages";
import { Choice } from "../ui/Choice";

export function EvidencePanel() {
  const { cues: byWhat, clothes } = messages.panel;
  return (
    <div class="subsection">
      <Choice
        name="cues"
        legend={byWhat.title}
        options={[
          { value: "SES", label: byWhat.shading },
          { value: "SE", label: byWhat.outline },
        ]}
        value={cues.value}
        onChange={(value) => (cues.value = value)}
      />
      <p class="fine">
        {cues.value === "SES" ? byWhat.shadingHelp : byWhat.outlineHelp}
      </p>
      <Choice
        name="clothing"
        legend={clothes.title}
        options={[
          { value: "auto", label: clothes.auto },
          { value: "tight", label: clothes.tight },
          { value: "loose", label: clothes.loose },
        ]}
        value={clothing.value}
        onChange={(value) => (clothing.value = value)}
      />
      <p class="fine">
        {clothes.help[clothing.value]}
      </p>
    </div>
  );
}
