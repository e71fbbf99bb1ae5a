// How the body's surface is drawn: Eq. 1 of the paper and its parts, or plain clay.
import { DoubleSide, GLSL3, ShaderMaterial, Texture, Vector2, Vector3 } from "three";
import type { GlbBody, GlbCamera } from "./glb";

export const SURFACES = ["lit", "clay", "albedo", "specularity", "shading", "residual", "change"] as const;
export type Surface = (typeof SURFACES)[number];

const VERTEX = /* glsl */ `
  in vec3 tint;
  in float albedo;
  in float specularity;
  in vec3 posed;
  in vec3 posedNormal;
  in float lit;
  in float posedLit;
  in float shift;
  in vec2 mark;
  out vec2 vMark;
  out float vLit;
  out float vPosedLit;
  out vec3 vPosition;
  out vec3 vNormal;
  out vec3 vTint;
  out vec2 vReflectance;
  out vec3 vPosed;
  out vec3 vPosedNormal;
  out float vShift;
  out vec3 vSeenNormal;
  void main() {
    vSeenNormal = normalMatrix * normal;
    vPosition = position;
    vNormal = normal;
    vTint = tint;
    vReflectance = vec2(albedo, specularity);
    vPosed = posed;
    vPosedNormal = posedNormal;
    vLit = lit;
    vPosedLit = posedLit;
    vShift = shift;
    vMark = mark;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

// r = b + a (l . n) l + s (h . n)^alpha l  (Eq. 1), l = 1 at the body's centre and falling with the
// square of the distance; a surface turned from the light shows ambient light alone. Where the light of the
// surroundings was found, r = a (E(n) + V (l . n) l) + s V (h . n)^alpha l, E in second-order spherical
// harmonics, V = 0 in the body's own shadow.
const FRAGMENT = /* glsl */ `
  precision highp float;
  in vec3 vPosition;
  in vec3 vNormal;
  in vec3 vTint;
  in vec2 vReflectance;
  in vec3 vPosed;
  in vec3 vPosedNormal;
  in float vShift;
  in float vLit;
  in float vPosedLit;
  in vec3 vSeenNormal;
  in vec2 vMark;
  uniform bool hasSurroundings;
  uniform float surroundings[9];
  uniform int surface;
  uniform bool isPoint;
  uniform vec3 lightVector;
  uniform vec3 posedLight;
  uniform float lightDistance;
  uniform float ambient;
  uniform float exponent;
  uniform vec3 eye;
  uniform vec3 clay;
  uniform sampler2D picture;
  uniform vec2 pictureSize;
  uniform vec3 intrinsics;
  out vec4 colour;

  vec2 eq1(vec3 position, vec3 normal, vec3 toEye, vec3 light) {
    vec3 path = isPoint ? light - position : light;
    float intensity = isPoint ? lightDistance * lightDistance / dot(path, path) : 1.0;
    vec3 toLight = normalize(path);
    float facing = dot(toLight, normal);
    if (facing <= 0.0) return vec2(0.0);
    float mirror = max(dot(normalize(toLight + toEye), normal), 0.0);
    return intensity * vec2(facing, pow(mirror, exponent));
  }

  float fromSurroundings(vec3 n) {
    float sum = 0.2820947918 * surroundings[0]
      + 0.4886025119 * dot(vec3(surroundings[3], surroundings[1], surroundings[2]), n)
      + 1.0925484306 * (surroundings[4] * n.x * n.y + surroundings[5] * n.y * n.z + surroundings[7] * n.x * n.z)
      + 0.3153915653 * surroundings[6] * (3.0 * n.z * n.z - 1.0)
      + 0.5462742153 * surroundings[8] * (n.x * n.x - n.y * n.y);
    return max(sum, 0.0);
  }

  // What a surface of this albedo and specularity shows, given the factors of Eq. 1.
  vec3 shaded(vec3 albedo, float specularity, vec3 normal, vec2 terms, float isLit) {
    if (!hasSurroundings) return ambient + albedo * terms.x + specularity * terms.y;
    return albedo * (fromSurroundings(normal) + isLit * terms.x) + specularity * isLit * terms.y;
  }

  vec3 encoded(vec3 linear) {
    vec3 clipped = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(clipped, vec3(1.0 / 2.4)) - 0.055, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
  }

  vec3 decoded(vec3 display) {
    return mix(pow((display + 0.055) / 1.055, vec3(2.4)), display / 12.92, lessThanEqual(display, vec3(0.04045)));
  }

  // The lamp walks along with the eye: no side of a form lies in the dark.
  vec3 claySurface(vec3 seen, vec3 normal, vec3 toEye) {
    float key = max(dot(seen, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float sky = 0.5 + 0.5 * seen.y;
    float rim = pow(1.0 - max(dot(normal, toEye), 0.0), 3.0);
    return clay * (0.16 + 0.22 * sky + 0.66 * key) + 0.05 * rim;
  }

  // Of the picture and of Eq. 1 at the same place of the surface, whatever it is seen from.
  vec3 residualSurface() {
    vec3 normal = normalize(vPosedNormal);
    vec3 toEye = normalize(-vPosed);
    if (dot(normal, toEye) < 0.2) return vec3(0.35);
    vec2 pixel = intrinsics.x * vec2(vPosed.x, -vPosed.y) / -vPosed.z + intrinsics.yz;
    vec2 place = pixel / pictureSize;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) return vec3(0.35);
    float seen = dot(decoded(texture(picture, vec2(place.x, 1.0 - place.y)).rgb), vec3(0.2126, 0.7152, 0.0722));
    vec2 terms = eq1(vPosed, normal, toEye, posedLight);
    float difference = seen - shaded(vec3(vReflectance.x), vReflectance.y, normal, terms, vPosedLit).x;
    float strength = clamp(abs(difference) / 0.12, 0.0, 1.0);
    vec3 hue = difference > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    return mix(vec3(0.78), hue, strength);
  }

  // How far shading moved the surface, full colour at 1 cm, over a little clay for its form.
  vec3 changeSurface(vec3 normal, vec3 toEye) {
    float strength = clamp(abs(vShift) / 0.01, 0.0, 1.0);
    vec3 hue = vShift > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    float form = 0.45 + 0.55 * max(dot(normal, toEye), 0.0);
    return form * mix(vec3(0.78), hue, strength);
  }

  void main() {
    vec3 normal = normalize(vNormal);
    vec3 toEye = normalize(eye - vPosition);
    vec3 seen = normalize(vSeenNormal);
    if (!gl_FrontFacing) {
      normal = -normal;
      seen = -seen;
    }
    vec2 terms = eq1(vPosition, normal, toEye, lightVector);
    vec3 linear;
    if (surface == 1) linear = claySurface(seen, normal, toEye);
    else if (surface == 2) linear = vTint;
    else if (surface == 3) linear = vec3(vReflectance.y);
    else if (surface == 4) linear = shaded(vec3(0.5), 0.2, normal, terms, vLit);
    else if (surface == 5) linear = residualSurface();
    else if (surface == 6) linear = changeSurface(normal, toEye);
    else linear = shaded(vTint, vReflectance.y, normal, terms, vLit);
    // Limbs that were turned, and the one pointed at.
    linear = mix(linear, vec3(0.08, 0.3, 0.75) * (0.4 + 0.6 * max(seen.z, 0.0)), 0.6 * clamp(vMark.y, 0.0, 1.0));
    linear = mix(linear, vec3(1.0, 0.38, 0.02) * (0.5 + 0.5 * max(seen.z, 0.0)), 0.55 * vMark.x);
    colour = vec4(encoded(linear), 1.0);
  }
`;

const CLAY = new Vector3(0.74, 0.66, 0.58);

export function surfaceMaterial(body: GlbBody, picture: Texture | null): ShaderMaterial {
  const { light } = body;
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    uniforms: {
      surface: { value: 0 },
      isPoint: { value: light?.kind === "point" },
      lightVector: { value: new Vector3(...(light?.vector ?? [0, 0, 1])) },
      posedLight: { value: new Vector3(...(light?.vector ?? [0, 0, 1])) },
      lightDistance: { value: light?.distance ?? 1 },
      hasSurroundings: { value: light?.surroundings != null },
      surroundings: { value: light?.surroundings ?? new Array<number>(9).fill(0) },
      ambient: { value: light?.ambient ?? 0.1 },
      exponent: { value: light?.exponent ?? 20 },
      eye: { value: new Vector3() },
      clay: { value: CLAY },
      picture: { value: picture },
      pictureSize: { value: pictureSize(body.camera) },
      intrinsics: { value: intrinsics(body.camera) },
    },
  });
}

function pictureSize(camera: GlbCamera | null): Vector2 {
  return new Vector2(camera?.width ?? 1, camera?.height ?? 1);
}

function intrinsics(camera: GlbCamera | null): Vector3 {
  return new Vector3(camera?.fx ?? 1, camera?.cx ?? 0, camera?.cy ?? 0);
}
