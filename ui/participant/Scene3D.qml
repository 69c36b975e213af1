import QtQuick
import QtQuick3D
import Passung 1.0

// The scene as it is drawn, for the participant and for the experimenter's mirror: the study says how. Millimetres, z up.
View3D {
    id: view
    required property var scene // SceneModel: what to draw
    property bool shadows: true
    property bool flat: false // for tests: each part in its own colour without light, and nothing else
    property int samples: scene.software && scene.heavy ? 1 : 2 // a pixel
    readonly property color ground: palette3d.ground
    readonly property QtObject palette3d: QtObject {
        readonly property color ground: view.scene.dark ? "#1b242c" : "#e9eef2"
        readonly property color rest: view.scene.dark ? "#8fa3b3" : "#9fb0bd"
        readonly property color otherHeld: view.scene.dark ? "#b9a3d6" : "#a58bc2" // by another hand
        readonly property color held: view.scene.dark ? "#f0b34a" : "#e8a02c"
        readonly property color hit: "#d52e00" // the held part with the visual cue at 1
        readonly property color mark: view.scene.dark ? "#56b4e9" : "#0072b2"
    }
    readonly property color heldColor: mixed(palette3d.held, palette3d.hit, scene.cue)

    function mixed(from, to, share) {
        return Qt.rgba(from.r + share * (to.r - from.r), from.g + share * (to.g - from.g), from.b + share * (to.b - from.b), 1);
    }
    function identity(index) {
        return Qt.hsva((0.11 + 0.381966 * index) % 1, 1, 1, 1);
    }

    environment: SceneEnvironment {
        backgroundMode: SceneEnvironment.Color
        clearColor: view.flat ? "black" : view.ground
        antialiasingMode: view.flat || view.samples < 2 ? SceneEnvironment.NoAA : SceneEnvironment.MSAA
        antialiasingQuality: view.samples < 4 ? SceneEnvironment.Medium : SceneEnvironment.High
    }

    PerspectiveCamera {
        position: view.scene.cameraPosition
        rotation: view.scene.cameraRotation
        fieldOfView: view.scene.cameraOpening
        clipNear: view.scene.cameraNear
        clipFar: view.scene.cameraFar
    }

    DirectionalLight {
        rotation: view.scene.lightRotation
        brightness: view.scene.light
        // A little blue, as a sky is.
        ambientColor: Qt.rgba(0.944 * view.scene.ambientLight, view.scene.ambientLight, 1.111 * view.scene.ambientLight, 1.0)
        castsShadow: view.shadows && view.scene.shadow > 0
        shadowMapQuality: view.scene.software ? Light.ShadowMapQualityMedium : Light.ShadowMapQualityHigh
        shadowFactor: 100 * view.scene.shadow
        shadowMapFar: 10 * view.scene.radius
    }
    DirectionalLight {
        rotation: view.scene.cameraRotation
        brightness: view.scene.fillLight
    }

    Model { // the ground
        visible: view.scene.ground && !view.flat
        source: "#Rectangle"
        position: view.scene.groundPosition
        scale: Qt.vector3d(0.01, 0.01, 0.01).times(40 * view.scene.radius)
        castsShadows: false
        materials: PrincipledMaterial {
            baseColor: view.scene.dark ? view.ground : "#c3ccd3"
            roughness: 1.0
            specularAmount: 0.0
        }
    }

    Repeater3D {
        model: view.scene.parts
        delegate: HandFrame {
            id: partFrame
            required property var modelData
            required property int index
            scene: view.scene
            hand: modelData.hand
            Model {
                geometry: PartGeometry {
                    mesh: partFrame.modelData.mesh
                }
                position: partFrame.modelData.held ? view.scene.heldPosition : partFrame.modelData.position
                rotation: partFrame.modelData.held ? view.scene.heldRotation : partFrame.modelData.rotation
                materials: PrincipledMaterial {
                    cullMode: partFrame.modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                    baseColor: view.flat ? view.identity(partFrame.index)
                        : partFrame.modelData.held ? view.heldColor
                        : partFrame.hand >= 0 ? view.palette3d.otherHeld : view.palette3d.rest
                    lighting: view.flat ? PrincipledMaterial.NoLighting : PrincipledMaterial.FragmentLighting
                    roughness: partFrame.modelData.held ? 0.38 : 0.5
                    metalness: 0.0
                    specularAmount: 0.4
                }
            }
        }
    }

    Repeater3D { // where the held part belongs at the start
        model: view.scene.ghosts
        delegate: Model {
            required property var modelData
            visible: view.scene.startMark && !view.flat
            geometry: PartGeometry {
                mesh: modelData.mesh
            }
            position: view.scene.startPosition
            rotation: view.scene.startRotation
            castsShadows: false
            opacity: 0.28
            materials: PrincipledMaterial {
                cullMode: modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                baseColor: view.palette3d.mark
                lighting: PrincipledMaterial.NoLighting
                alphaMode: PrincipledMaterial.Blend
            }
        }
    }

    Repeater3D { // what the trial asks for
        model: view.scene.marks
        delegate: HandFrame {
            id: markFrame
            required property var modelData
            scene: view.scene
            hand: modelData.hand
            Model {
                // One pale image at a time.
                visible: !view.flat && !(markFrame.modelData.pale && view.scene.startMark)
                geometry: PartGeometry {
                    mesh: markFrame.modelData.mesh
                }
                position: markFrame.modelData.position
                rotation: markFrame.modelData.rotation
                castsShadows: false
                opacity: markFrame.modelData.pale ? 0.28 : 1
                materials: PrincipledMaterial {
                    baseColor: view.palette3d.mark
                    lighting: PrincipledMaterial.NoLighting
                    cullMode: markFrame.modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                    alphaMode: markFrame.modelData.pale ? PrincipledMaterial.Blend : PrincipledMaterial.Opaque
                }
            }
        }
    }

    Node { // the force on the hand
        visible: view.scene.arrow && !view.flat
        position: view.scene.arrowPosition
        rotation: view.scene.arrowRotation
        readonly property real thick: 0.028 * view.scene.radius
        Model {
            source: "#Cylinder"
            castsShadows: false
            position: Qt.vector3d(0, 0.5 * view.scene.arrowLength, 0)
            scale: Qt.vector3d(0.01 * parent.thick, 0.01 * view.scene.arrowLength, 0.01 * parent.thick)
            materials: arrowMaterial
        }
        Model {
            source: "#Cone"
            castsShadows: false
            position: Qt.vector3d(0, view.scene.arrowLength, 0)
            scale: Qt.vector3d(0.028 * parent.thick, 0.035 * parent.thick, 0.028 * parent.thick)
            materials: arrowMaterial
        }
    }
    PrincipledMaterial {
        id: arrowMaterial
        baseColor: "#d55e00"
        lighting: PrincipledMaterial.NoLighting
    }
}
