import QtQuick
import QtQuick.Layouts
import "../controls"

// Writes the whole database as tables, with a report of the planned analyses if that is asked for.
ColumnLayout {
    id: view
    spacing: 10
    RowLayout {
        Layout.fillWidth: true
        spacing: 12
        TextBox {
            id: folder
            objectName: "exportFolder"
            Layout.fillWidth: true
            placeholderText: qsTr("Folder")
            property bool own: false // typed by somebody
            text: records.proposedFolder
            onTextEdited: own = true
            Connections {
                target: records
                function onChanged() {
                    if (!folder.own)
                        folder.text = records.proposedFolder;
                }
            }
        }
        Tick {
            id: samples
            objectName: "exportSamples"
            text: qsTr("with every tick")
            checked: true
        }
        ActionButton {
            objectName: "report"
            text: qsTr("Report")
            visible: !records.exporting
            why: run.running ? qsTr("R would take time from the running session.") : ""
            onClicked: records.reportTo(folder.text, samples.checked)
        }
        ActionButton {
            objectName: "export"
            text: records.exporting ? qsTr("Cancel") : qsTr("Export")
            kind: records.exporting ? "plain" : "main"
            onClicked: records.exporting ? records.cancelExport() : records.exportTo(folder.text, samples.checked)
        }
    }
    Rectangle { // progress
        Layout.fillWidth: true
        implicitHeight: 4
        radius: 2
        color: look.edge
        opacity: records.exporting ? 1 : 0
        Accessible.role: Accessible.ProgressBar
        Accessible.name: qsTr("Export: %1 %").arg(Math.round(100 * records.exported))
        Rectangle {
            height: parent.height
            radius: 2
            width: parent.width * records.exported
            color: look.accent
        }
    }
    RowLayout {
        Layout.fillWidth: true
        spacing: 12
        Say {
            Layout.fillWidth: true
            quiet: true
            font.pixelSize: look.scale * 12
            wrapMode: Text.WordWrap
            maximumLineCount: 2
            text: records.reporting && records.exported >= 1 ? qsTr("R computes the planned analyses …") : records.exporting ? qsTr("%1 %").arg(Math.round(100 * records.exported)) : qsTr("CSV tables with a codebook; a report adds the planned analyses, computed by R. An earlier export in the folder is replaced, a folder with other files is refused.")
        }
        ActionButton {
            objectName: "openReport"
            visible: records.lastReport !== ""
            text: qsTr("Open the report")
            onClicked: Qt.openUrlExternally("file://" + records.lastReport)
        }
        ActionButton {
            objectName: "openFolder"
            visible: records.lastFolder !== ""
            text: qsTr("Open the folder")
            onClicked: Qt.openUrlExternally("file://" + records.lastFolder)
        }
    }
}
