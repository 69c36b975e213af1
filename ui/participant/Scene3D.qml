import QtQuick
import QtQuick3D

// The scene as it is drawn, for the participant and for the experimenter's mirror. Millimetres, z up.
View3D {
    id: view
    required property var scene // Screen: what to draw
    property bool shadows: true
    readonly property color ground: palette3d.ground
    readonly property QtObject palette3d: QtObject {
        readonly property color ground: look.dark ? "#1b242c" : "#e9eef2"
        readonly property color rest: look.dark ? "#8fa3b3" : "#9fb0bd"
        readonly property color held: look.dark ? "#f0b34a" : "#e8a02c"
        readonly property color mark: look.dark ? "#56b4e9" : "#0072b2"
    }

    environment: SceneEnvironment {
        backgroundMode: SceneEnvironment.Color
        clearColor: view.ground
        antialiasingMode: view.scene.software && view.scene.heavy ? SceneEnvironment.NoAA : SceneEnvironment.MSAA
        antialiasingQuality: SceneEnvironment.Medium
    }

    PerspectiveCamera {
        position: view.scene.cameraPosition
        rotation: view.scene.cameraRotation
        fieldOfView: view.scene.cameraOpening
        clipNear: view.scene.cameraNear
        clipFar: view.scene.cameraFar
    }

    DirectionalLight {
        // From above, behind the left shoulder.
        rotation: view.scene.lightRotation
        brightness: 1.0
        ambientColor: Qt.rgba(0.34, 0.36, 0.4, 1.0)
        castsShadow: view.shadows
        shadowMapQuality: view.scene.software ? Light.ShadowMapQualityMedium : Light.ShadowMapQualityHigh
        shadowFactor: 55
        shadowMapFar: 10 * view.scene.radius
    }
    DirectionalLight {
        rotation: view.scene.cameraRotation
        brightness: 0.32
    }

    Model { // the ground
        source: "#Rectangle"
        position: view.scene.groundPosition
        scale: Qt.vector3d(0.01, 0.01, 0.01).times(40 * view.scene.radius)
        castsShadows: false
        materials: PrincipledMaterial {
            baseColor: look.dark ? view.ground : "#c3ccd3"
            roughness: 1.0
            specularAmount: 0.0
        }
    }

    Repeater3D {
        model: view.scene.parts
        delegate: Model {
            required property var modelData
            geometry: modelData.geometry
            position: modelData.held ? view.scene.heldPosition : modelData.position
            rotation: modelData.held ? view.scene.heldRotation : modelData.rotation
            castsShadows: modelData.casts
            materials: PrincipledMaterial {
                baseColor: modelData.held ? view.scene.heldColor(view.palette3d.held) : view.palette3d.rest
                roughness: modelData.held ? 0.38 : 0.5
                metalness: 0.0
                specularAmount: 0.4
            }
        }
    }

    Model { // where the held part belongs at the start
        visible: view.scene.startMark
        geometry: view.scene.heldGeometry
        position: view.scene.startPosition
        rotation: view.scene.startRotation
        castsShadows: false
        opacity: 0.28
        materials: PrincipledMaterial {
            baseColor: view.palette3d.mark
            lighting: PrincipledMaterial.NoLighting
            alphaMode: PrincipledMaterial.Blend
        }
    }

    Repeater3D { // what the trial asks for
        model: view.scene.marks
        delegate: Model {
            required property var modelData
            visible: !(modelData.pale && view.scene.startMark) // one pale image at a time
            geometry: modelData.geometry
            position: modelData.position
            rotation: modelData.rotation
            castsShadows: false
            opacity: modelData.pale ? 0.28 : 1
            materials: PrincipledMaterial {
                baseColor: view.palette3d.mark
                lighting: PrincipledMaterial.NoLighting
                alphaMode: modelData.pale ? PrincipledMaterial.Blend : PrincipledMaterial.Opaque
            }
        }
    }

    Node { // the force on the hand
        visible: view.scene.arrow
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
