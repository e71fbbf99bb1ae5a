import{A as t,c as o,g as i,k as a}from"/page/chunk.DKD75HTU.js";var v=["clay","lit","albedo","specularity","shading"],n=`
  in vec3 calm;
  in vec3 tint;
  in float specularity;
  in vec2 mark;
  out vec2 vMark;
  out vec3 vPosition;
  out vec3 vNormal;
  out vec3 vTint;
  out float vSpecularity;
  out vec3 vSeenNormal;
  uniform int surface;
  void main() {
    vSeenNormal = normalMatrix * (surface == 0 ? calm : normal);
    vPosition = position;
    vNormal = normal;
    vTint = tint;
    // Cloth that was taken for skin would be chrome; skin has at most 0.1.
    vSpecularity = min(specularity, 0.15);
    vMark = mark;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,r=`
  precision highp float;
  in vec3 vPosition;
  in vec3 vNormal;
  in vec3 vTint;
  in float vSpecularity;
  in vec3 vSeenNormal;
  in vec2 vMark;
  uniform int surface;
  uniform bool isPoint;
  uniform vec3 lightVector;
  uniform float lightDistance;
  uniform float ambient;
  uniform float exponent;
  uniform vec3 eye;
  uniform vec3 clay;
  out vec4 colour;

  vec2 eq1(vec3 position, vec3 normal, vec3 toEye) {
    vec3 path = isPoint ? lightVector - position : lightVector;
    float intensity = isPoint ? lightDistance * lightDistance / dot(path, path) : 1.0;
    vec3 toLight = normalize(path);
    float facing = dot(toLight, normal);
    if (facing <= 0.0) return vec2(0.0);
    float mirror = max(dot(normalize(toLight + toEye), normal), 0.0);
    return intensity * vec2(facing, pow(mirror, exponent));
  }

  // What a surface of this albedo and specularity shows, given the factors of Eq. 1.
  vec3 shaded(vec3 albedo, float specularity, vec2 terms) {
    return ambient + albedo * terms.x + specularity * terms.y;
  }

  vec3 encoded(vec3 linear) {
    vec3 clipped = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(clipped, vec3(1.0 / 2.4)) - 0.055, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
  }

  // The lamp walks along with the eye: no side of a form lies in the dark.
  vec3 claySurface(vec3 seen, vec3 normal, vec3 toEye) {
    float key = max(dot(seen, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float sky = 0.5 + 0.5 * seen.y;
    float rim = pow(1.0 - max(dot(normal, toEye), 0.0), 3.0);
    return clay * (0.16 + 0.22 * sky + 0.66 * key) + 0.05 * rim;
  }

  void main() {
    vec3 normal = normalize(vNormal);
    vec3 toEye = normalize(eye - vPosition);
    vec3 seen = normalize(vSeenNormal);
    if (!gl_FrontFacing) {
      normal = -normal;
      seen = -seen;
    }
    vec2 terms = eq1(vPosition, normal, toEye);
    vec3 linear;
    if (surface == 0) linear = claySurface(seen, normal, toEye);
    else if (surface == 1) linear = shaded(vTint, vSpecularity, terms);
    else if (surface == 2) linear = vTint;
    else if (surface == 3) linear = vec3(vSpecularity);
    else linear = shaded(vec3(0.5), 0.2, terms);
    // Limbs that were turned, and the one pointed at.
    linear = mix(linear, vec3(0.08, 0.3, 0.75) * (0.4 + 0.6 * max(seen.z, 0.0)), 0.6 * clamp(vMark.y, 0.0, 1.0));
    linear = mix(linear, vec3(1.0, 0.38, 0.02) * (0.5 + 0.5 * max(seen.z, 0.0)), 0.55 * vMark.x);
    colour = vec4(encoded(linear), 1.0);
  }
`,l=new a(.74,.66,.58);function s({light:e}){return new t({glslVersion:i,vertexShader:n,fragmentShader:r,side:o,uniforms:{surface:{value:0},isPoint:{value:e?.kind==="point"},lightVector:{value:new a(...e?.vector??[0,0,1])},lightDistance:{value:e?.distance??1},ambient:{value:e?.ambient??.1},exponent:{value:e?.exponent??20},eye:{value:new a},clay:{value:l}}})}export{v as a,s as b};
